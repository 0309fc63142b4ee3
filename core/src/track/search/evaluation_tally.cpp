#include "track/search/evaluation_tally.hpp"

#include <fmt/format.h>

#include <cmath>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

[[noreturn]] void refuse_answer(const std::string& who, const std::string& what) {
  throw PluginError(fmt::format("{}: {}; this is a bug in the optimizer", who, what));
}

void check_point(const Eigen::VectorXd& point, const SearchRegion& region, const std::string& who) {
  constexpr double kRounding = 1e-9;
  if (point.size() != region.start.size())
    refuse_answer(who, fmt::format("its answer has {} numbers, expected {}", point.size(),
                                   region.start.size()));
  for (Eigen::Index i = 0; i < point.size(); ++i) {
    const double slack = kRounding * std::max(1.0, std::abs(point[i]));
    if (std::isfinite(point[i]) && point[i] >= region.lower[i] - slack &&
        point[i] <= region.upper[i] + slack)
      continue;
    refuse_answer(who, fmt::format("number {} of its answer is {}, expected {} to {}", i, point[i],
                                   region.lower[i], region.upper[i]));
  }
}

}  // namespace

void check_answer(OptimizerResult& answer, const EvaluationTally& tally, const SearchRegion& region,
                  const Budget& budget, const std::string& who) {
  check_point(answer.point, region, who);
  if (std::isnan(answer.cost) || (!tally.on_device && answer.cost < tally.lowest))
    refuse_answer(who,
                  fmt::format("its answer has cost {}, but the lowest of the {} points that it "
                              "evaluated has {}",
                              answer.cost, tally.evaluations, tally.lowest));
  if (answer.evaluations < 0)
    refuse_answer(who, fmt::format("says that it made {} evaluations", answer.evaluations));
  answer.evaluations =
      tally.on_device ? std::max(answer.evaluations, tally.evaluations) : tally.evaluations;
  if (answer.evaluations > budget.evaluations)
    refuse_answer(who, fmt::format("made {} evaluations, its budget is {}", answer.evaluations,
                                   budget.evaluations));
}

}  // namespace hypotrack::internal
