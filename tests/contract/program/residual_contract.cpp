#include "residual_contract.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>

#include "hypotrack/api/error.hpp"
#include "jacobian_contract.hpp"
#include "report.hpp"

namespace hypotrack::contract {
namespace {

/// Writes the residuals of a hypothesis. Throws unless what lies behind them stays.
void write_residuals(const Setting& setting, std::size_t i, std::span<float> residuals) {
  constexpr std::size_t kBehind = 64;
  constexpr float kUntouched = -8191.25f;
  std::vector<float> memory(residuals.begin(), residuals.end());
  memory.resize(residuals.size() + kBehind, kUntouched);
  try {
    setting.objective->residual_term()->write_residuals(setting.drawn(i),
                                                        std::span(memory).first(residuals.size()));
  } catch (const PluginError& error) {
    throw Violation(setting.at(i) + ": " + error.what());
  }
  const std::span<const float> behind = std::span(memory).last(kBehind);
  require(std::ranges::count(behind, kUntouched) == static_cast<std::ptrdiff_t>(kBehind),
          setting.at(i) + ": more residuals are written than residual_count(), which is " +
              std::to_string(residuals.size()));
  std::ranges::copy(std::span(memory).first(residuals.size()), residuals.begin());
}

/// Writes the residuals of all hypotheses, one after the other, into memory that held `before`.
std::vector<float> residuals(const Setting& setting, float before) {
  const ResidualTerm& term = *setting.objective->residual_term();
  const auto size = static_cast<std::size_t>(term.residual_count());
  std::vector<float> all(size * setting.hypotheses.size(), before);
  for (std::size_t i = 0; i < setting.hypotheses.size(); ++i) {
    write_residuals(setting, i, std::span(all).subspan(i * size, size));
  }
  return all;
}

/// Returns the sums of squares of the residuals, one per hypothesis.
std::vector<double> sums_of_squares(const Setting& setting) {
  const std::vector<float> all = residuals(setting, 0.0f);
  const std::size_t size = all.size() / setting.hypotheses.size();
  std::vector<double> sums;
  for (std::size_t i = 0; i < setting.hypotheses.size(); ++i) {
    double sum = 0;
    for (const float r : std::span(all).subspan(i * size, size)) sum += static_cast<double>(r) * r;
    sums.push_back(sum);
  }
  return sums;
}

}  // namespace

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

std::optional<double> rate_of_squares(const Setting& setting) {
  const std::vector<double> costs = setting.costs(), sums = sums_of_squares(setting);
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < costs.size(); ++i)
    if (setting.hypotheses[i].of_the_scene && std::isfinite(costs[i])) used.push_back(i);
  const auto count = static_cast<double>(used.size());
  double mean_cost = 0, mean_sum = 0, largest = 0;
  for (const std::size_t i : used) {
    mean_cost += costs[i] / count;
    mean_sum += sums[i] / count;
    largest = std::max({largest, std::abs(costs[i]), sums[i]});
  }
  double spread = 0, product = 0;
  for (const std::size_t i : used) {
    spread += (costs[i] - mean_cost) * (costs[i] - mean_cost);
    product += (costs[i] - mean_cost) * (sums[i] - mean_sum);
  }
  if (std::sqrt(spread) <= 1e-6 * largest) return std::nullopt;
  return product / spread;
}

void check_rates(std::vector<double> rates) {
  if (rates.empty()) throw Skipped("the cost is the same for every state of the scene");
  const auto middle = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2);
  std::ranges::nth_element(rates, middle);
  require(*middle > 0.25 && *middle < 4,
          "from state to state the sum changes by " + std::to_string(*middle) +
              " times as much as the cost; expected about 1, because least squares takes it for "
              "the cost");
}

void check_cost_and_residuals(const Setting& setting) {
  const std::vector<float> alone = residuals(setting, 0.0f);
  const std::size_t size = alone.size() / setting.hypotheses.size();
  std::vector<float> own(size);
  for (std::size_t i = 0; i < setting.hypotheses.size(); ++i) {
    const double expected = setting.cost(i);
    const double cost = setting.objective->cost_and_residuals(setting.drawn(i), own);
    require(cost == expected || std::abs(cost - expected) <= 1e-4 * (1 + std::abs(expected)),
            setting.at(i) + ": it returns " + std::to_string(cost) + ", and cost() returns " +
                std::to_string(expected));
    for (std::size_t k = 0; k < size; ++k) {
      const float residual = alone[i * size + k];
      require(std::abs(own[k] - residual) <= 1e-4f * (1 + std::abs(residual)),
              setting.at(i) + ": residual " + std::to_string(k) + " is " + std::to_string(own[k]) +
                  ", and write_residuals() writes " + std::to_string(residual));
    }
  }
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
      term->write_slopes(setting.drawn(k), i, own, slopes);
      for (std::size_t p = 0; p < size; ++p) {
        require(std::abs(own[p] - expected[first + p]) <= 1e-4f * (1 + std::abs(own[p])),
                setting.at(k) + ": with slopes, residual " + std::to_string(first + p) +
                    " is another one");
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
    check_jacobian(*setting.objective, *setting.observation.scene, setting.drawn(i), setting.at(i));
  }
}

}  // namespace hypotrack::contract
