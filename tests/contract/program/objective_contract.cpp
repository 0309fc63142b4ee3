#include <algorithm>
#include <future>

#include "device_contract.hpp"
#include "plugin/running_plugin.hpp"
#include "residual_contract.hpp"
#include "setting.hpp"
#include "subject.hpp"

namespace hypotrack::contract {
namespace {

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
    settings.push_back(std::move(setting));
  }
  require(!settings.empty(), "it refuses every observation, the last one as " + refusal);
  return settings;
}

void prepare_again(std::vector<Setting>& settings) {
  for (Setting& setting : settings) setting.prepare();
}

void check_repeatable(const Setting& setting) {
  require(setting.costs() == setting.costs(), setting.name + ": scoring twice gives two costs");
}

void check_stateless(const Setting& setting) {
  const std::vector<double> forward = setting.costs();
  for (std::size_t i = forward.size(); i-- > 0;) {
    const double backward = setting.cost(i);
    require(forward[i] == backward,
            setting.at(i) + ": the cost depends on what was scored before: " +
                std::to_string(forward[i]) + " or " + std::to_string(backward));
  }
}

void check_threads(const Setting& setting) {
  const std::vector<double> expected = setting.costs();
  std::vector<std::future<bool>> threads;
  for (int t = 0; t < 4; ++t) {
    threads.push_back(std::async(std::launch::async, [&] {
      bool all_same = true;
      for (int round = 0; round < 8; ++round) all_same &= setting.costs() == expected;
      return all_same;
    }));
  }
  bool all_same = true;
  for (auto& thread : threads) all_same &= thread.get();
  require(all_same, setting.name + ": four threads scoring at once differ from one");
}

void check_second_object(const Subject& subject, const Setting& setting) {
  // Both have seen exactly this one observation.
  const auto first = subject.make<Objective>();
  const auto second = subject.make<Objective>();
  first->prepare(setting.observation);
  second->prepare(setting.observation);
  require(setting.costs_by(*first) == setting.costs_by(*second),
          setting.name + ": two objects give two costs");
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
  const auto each = [&](const auto& check) {
    for (const Setting& setting : settings) {
      const std::string where = " in the row above, with " + setting.name;
      const detail::RunningPlugin running(subject.who.c_str(), where.c_str());
      check(setting);
    }
  };
  report.row("costs are numbers or +infinity, whatever the depth",
             [&] { each([](const Setting& setting) { setting.costs(); }); });
  const bool are_numbers = report.passed();
  const auto each_of_numbers = [&](const auto& check) {
    if (!are_numbers) throw Skipped("its costs are no numbers");
    each(check);
  };
  report.row("scoring twice gives the same", [&] { each_of_numbers(check_repeatable); });
  report.row("costs do not depend on what was scored before",
             [&] { each_of_numbers(check_stateless); });
  report.row("several threads score the same", [&] { each_of_numbers(check_threads); });
  report.row("a second object scores the same", [&] {
    each_of_numbers([&](const Setting& setting) { check_second_object(subject, setting); });
  });
  report.row("it can take in a frame after a frame", [&] {
    prepare_again(settings);
    if (!are_numbers) throw Skipped("its costs are no numbers after one frame");
    each([](const Setting& setting) { setting.costs(); });
  });
  report.row("residuals are finite, complete and the same from several threads",
             [&] { each(check_residuals); });
  const bool has_residuals = report.passed();
  const auto each_residual = [&](const auto& check) {
    if (!has_residuals) throw Skipped("it has no residuals, or wrong ones");
    each(check);
  };
  const auto each_with_cost = [&](const auto& check) {
    if (!are_numbers) throw Skipped("its costs are no numbers");
    each_residual(check);
  };
  report.row("cost and residuals are the same when asked for at once",
             [&] { each_with_cost(check_cost_and_residuals); });
  std::vector<double> rates;
  report.row("the sum of squared residuals rises and falls with the cost", [&] {
    each_with_cost([&](const Setting& setting) {
      if (const auto rate = rate_of_squares(setting)) rates.push_back(*rate);
    });
    check_rates(rates);
  });
  report.row("residuals of pixels have finite slopes, and are the same with them",
             [&] { each_residual(check_slopes); });
  report.row("Jacobians are those of the residuals", [&] { each_residual(check_jacobians); });
  check_on_device(report, subject);
}

}  // namespace hypotrack::contract
