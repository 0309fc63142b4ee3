#include <algorithm>
#include <cmath>
#include <future>

#include "device_contract.hpp"
#include "drawn_tiles.hpp"
#include "jacobian_contract.hpp"
#include "subject.hpp"

namespace hypotrack::contract {
namespace {

RenderedHypothesis as_drawn_for(const Objective& objective, const NamedHypothesis& hypothesis) {
  RenderedHypothesis rendered;
  rendered.state = {hypothesis.state.data(), static_cast<std::size_t>(hypothesis.state.size())};
  if (objective.needs_rendering()) rendered.views = hypothesis.depth.tiles();
  return rendered;
}

/// Returns the costs of hypotheses, scored in the given order.
std::vector<double> score(const Objective& objective,
                          const std::vector<NamedHypothesis>& hypotheses,
                          const std::vector<std::size_t>& order) {
  std::vector<double> costs;
  for (const std::size_t i : order) {
    costs.push_back(objective.cost(as_drawn_for(objective, hypotheses[i])));
  }
  return costs;
}

/// An objective prepared with an observation, and hypotheses drawn for it.
struct Setting {
  std::string name;
  Observation observation;
  std::unique_ptr<Objective> objective;
  std::vector<NamedHypothesis> hypotheses;
  std::vector<std::size_t> order;  ///< 0, 1, 2, ...

  std::vector<double> costs() const { return score(*objective, hypotheses, order); }
  std::string at(std::size_t i) const { return hypotheses[i].name + ", " + name; }
};

/// Makes settings for all observations that the objective accepts. It must refuse the others with a
/// DataError.
std::vector<Setting> make_settings(const Subject& subject) {
  std::vector<Setting> settings;
  std::string refusal;
  for (NamedObservation& named : make_observations(*subject.scene)) {
    Setting setting;
    setting.name = named.name;
    setting.observation = std::move(named.observation);
    setting.objective = subject.make<Objective>();
    try {
      setting.objective->prepare(setting.observation);
    } catch (const DataError& error) {
      refusal = setting.name + ": " + error.what();
      continue;
    } catch (const std::exception& error) {
      throw Violation(setting.name + ": prepare() threw another exception: " + error.what() +
                      ". Throw hypotrack::DataError where an observation does not suit");
    }
    setting.hypotheses = make_hypotheses(*subject.scene, setting.observation);
    for (std::size_t i = 0; i < setting.hypotheses.size(); ++i) setting.order.push_back(i);
    settings.push_back(std::move(setting));
  }
  require(!settings.empty(), "it refuses every observation, the last one as " + refusal);
  return settings;
}

// Prepares again, because settings move and prepared objectives point to the observation inside.
void prepare_again(std::vector<Setting>& settings) {
  for (Setting& setting : settings) setting.objective->prepare(setting.observation);
}

void check_numbers(const Setting& setting) {
  const std::vector<double> costs = setting.costs();
  for (std::size_t i = 0; i < costs.size(); ++i) {
    require(!std::isnan(costs[i]), setting.at(i) + ": the cost is NaN");
    require(costs[i] > -std::numeric_limits<double>::infinity(),
            setting.at(i) + ": the cost is -infinity, expected a number or +infinity");
  }
}

void check_repeatable(const Setting& setting) {
  require(setting.costs() == setting.costs(), setting.name + ": scoring twice gives two costs");
}

void check_stateless(const Setting& setting) {
  const std::vector<double> forward = setting.costs();
  const std::vector<std::size_t> order(setting.order.rbegin(), setting.order.rend());
  std::vector<double> backward = score(*setting.objective, setting.hypotheses, order);
  std::ranges::reverse(backward);
  for (std::size_t i = 0; i < forward.size(); ++i) {
    require(forward[i] == backward[i],
            setting.at(i) + ": the cost depends on what was scored before: " +
                std::to_string(forward[i]) + " or " + std::to_string(backward[i]));
  }
}

void check_threads(const Setting& setting) {
  const std::vector<double> expected = setting.costs();
  std::vector<std::future<bool>> threads;
  for (int t = 0; t < 4; ++t) {
    threads.push_back(std::async(std::launch::async, [&] {
      bool same = true;
      for (int round = 0; round < 8; ++round) same &= setting.costs() == expected;
      return same;
    }));
  }
  bool same = true;
  for (auto& thread : threads) same &= thread.get();
  require(same, setting.name + ": four threads scoring at once differ from one");
}

void check_second_object(const Subject& subject, const Setting& setting) {
  // Both have seen exactly this one observation.
  const auto first = subject.make<Objective>();
  const auto second = subject.make<Objective>();
  first->prepare(setting.observation);
  second->prepare(setting.observation);
  require(score(*first, setting.hypotheses, setting.order) ==
              score(*second, setting.hypotheses, setting.order),
          setting.name + ": two objects give two costs");
}

/// Writes the residuals of a hypothesis. Throws unless what lies behind them stays.
void write_residuals(const Setting& setting, std::size_t i, std::span<float> residuals) {
  constexpr std::size_t kBehind = 64;
  constexpr float kUntouched = -8191.25f;
  std::vector<float> memory(residuals.begin(), residuals.end());
  memory.resize(residuals.size() + kBehind, kUntouched);
  setting.objective->residual_term()->write_residuals(
      as_drawn_for(*setting.objective, setting.hypotheses[i]),
      std::span(memory).first(residuals.size()));
  const std::span<const float> behind = std::span(memory).last(kBehind);
  require(std::ranges::count(behind, kUntouched) == static_cast<std::ptrdiff_t>(kBehind),
          setting.at(i) + ": more residuals are written than residual_count(), which is " +
              std::to_string(residuals.size()));
  std::ranges::copy(std::span(memory).first(residuals.size()), residuals.begin());
}

/// Writes the residuals of all hypotheses, one after the other, into memory that held `before`.
std::vector<float> residuals(const Setting& setting, float before) {
  const ResidualTerm& term = *setting.objective->residual_term();
  const std::int64_t count = term.residual_count();
  require(count >= 0, setting.name + ": residual_count() is " + std::to_string(count));
  const auto size = static_cast<std::size_t>(count);
  std::vector<float> all(size * setting.hypotheses.size(), before);
  for (std::size_t i = 0; i < setting.hypotheses.size(); ++i) {
    write_residuals(setting, i, std::span(all).subspan(i * size, size));
    for (std::size_t k = i * size; k < (i + 1) * size; ++k) {
      require(std::isfinite(all[k]), setting.at(i) + ": residual " + std::to_string(k - i * size) +
                                         " is " + std::to_string(all[k]) +
                                         ", expected a finite number");
    }
  }
  return all;
}

void check_residuals(const Setting& setting) {
  if (!setting.objective->residual_term()) throw Skipped("it offers none");
  const std::vector<float> expected = residuals(setting, 0.0f);
  const std::vector<float> again = residuals(setting, 7.0f);
  const auto differ = std::ranges::mismatch(again, expected);
  const auto count = static_cast<std::size_t>(setting.objective->residual_term()->residual_count());
  const auto at = static_cast<std::size_t>(differ.in1 - again.begin());
  if (differ.in1 != again.end())
    throw Violation(setting.name + ": not all of them are written: residual " +
                    std::to_string(at % count) + " keeps what was there. residual_count() says " +
                    std::to_string(count));
  std::vector<std::future<bool>> threads;
  for (int t = 0; t < 4; ++t) {
    threads.push_back(
        std::async(std::launch::async, [&] { return residuals(setting, 0.0f) == expected; }));
  }
  bool same = true;
  for (auto& thread : threads) same &= thread.get();
  require(same, setting.name + ": four threads writing at once differ from one");
}

void check_slopes(const Setting& setting) {
  const ResidualTerm* term = setting.objective->residual_term();
  if (!term || !term->has_slopes()) throw Skipped("it offers none");
  const std::vector<float> expected = residuals(setting, 0.0f);
  const auto count = static_cast<std::size_t>(term->residual_count());
  for (std::size_t k = 0; k < setting.hypotheses.size(); ++k) {
    std::size_t first = k * count;
    for (std::size_t i = 0; i < term->pixel_views().size(); ++i) {
      const auto view = static_cast<std::size_t>(term->pixel_views()[i]);
      const TileCamera& tile = setting.observation.views.at(view).camera;
      const auto size =
          static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
      require(first + size <= (k + 1) * count, setting.at(k) + ": fewer residuals than pixels");
      std::vector<float> own(size, NAN), slopes(size, NAN);
      term->write_slopes(as_drawn_for(*setting.objective, setting.hypotheses[k]), i, own, slopes);
      for (std::size_t p = 0; p < size; ++p) {
        require(std::abs(own[p] - expected[first + p]) <= 1e-4f * (1 + std::abs(own[p])),
                setting.at(k) + ": with slopes, residual " + std::to_string(first + p) +
                    " is another one");
        require(std::isfinite(slopes[p]), setting.at(k) + ": a slope is not a finite number");
      }
      first += size;
    }
    require(first == (k + 1) * count, setting.at(k) + ": more residuals than pixels");
  }
}

void check_jacobians(const Setting& setting) {
  const ResidualTerm* term = setting.objective->residual_term();
  if (!term || !term->has_jacobian()) throw Skipped("it offers none");
  for (std::size_t i = 0; i < setting.hypotheses.size(); ++i) {
    check_jacobian(*setting.objective, *setting.observation.scene,
                   as_drawn_for(*setting.objective, setting.hypotheses[i]), setting.at(i));
  }
}

void check_claims(const Subject& subject) {
  const auto objective = subject.make<Objective>();
  const ResidualTerm* term = objective->residual_term();
  require(term || !subject.claims("residuals"),
          "they claim residuals, and residual_term() is null");
  require((term && term->has_slopes()) || !subject.claims("slopes"),
          "they claim slopes, and has_slopes() is false");
  require((term && term->has_jacobian()) || !subject.claims("jacobian"),
          "they claim a jacobian, and has_jacobian() is false");
}

}  // namespace

void check_objective(Report& report, const Subject& subject) {
  if (!check_parameters<Objective>(report, subject)) return;
  report.row("it has what its capabilities claim", [&] { check_claims(subject); });
  std::vector<Setting> settings;
  report.row("it takes observations in or refuses them with a DataError", [&] {
    settings = make_settings(subject);
    prepare_again(settings);
  });
  if (settings.empty()) return;
  const auto each = [&](const auto& check) { std::ranges::for_each(settings, check); };
  report.row("costs are numbers or +infinity, whatever the depth", [&] { each(check_numbers); });
  report.row("scoring twice gives the same", [&] { each(check_repeatable); });
  report.row("costs do not depend on what was scored before", [&] { each(check_stateless); });
  report.row("several threads score the same", [&] { each(check_threads); });
  report.row("a second object scores the same",
             [&] { each([&](const Setting& setting) { check_second_object(subject, setting); }); });
  report.row("it can take in a frame after a frame", [&] {
    prepare_again(settings);
    each(check_numbers);
  });
  report.row("residuals are finite, complete and the same from several threads",
             [&] { each(check_residuals); });
  report.row("residuals of pixels have finite slopes, and are the same with them",
             [&] { each(check_slopes); });
  report.row("Jacobians are those of the residuals", [&] { each(check_jacobians); });
  check_on_device(report, subject);
}

}  // namespace hypotrack::contract
