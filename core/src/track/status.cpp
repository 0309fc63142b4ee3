#include "track/status.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack {

std::string_view to_string(Status status) {
  static constexpr std::array<std::string_view, 5> names{"tracked", "uncertain", "lost", "absent",
                                                         "missing"};
  return names[static_cast<std::size_t>(status)];
}

}  // namespace hypotrack

namespace hypotrack::internal {

double StatusMonitor::usual_cost() const {
  constexpr std::size_t kEnough = 5;  // too few costs to compare with below that
  if (costs_.size() < kEnough) return -std::numeric_limits<double>::infinity();
  const std::vector<double> costs(costs_.begin(), costs_.end());
  const double expected = upper_median(costs);
  std::vector<double> deviations;
  deviations.reserve(costs.size());
  for (double c : costs) deviations.push_back(std::abs(c - expected));
  // 1.4826 MAD estimates a normal distribution's standard deviation. The floor keeps a nearly
  // constant cost from making every frame an outlier.
  const double deviation =
      std::max(1.4826 * upper_median(std::move(deviations)), 0.02 * std::abs(expected));
  return expected + settings_.outlier * deviation;
}

void StatusMonitor::remember(double cost) {
  costs_.push_back(cost);
  if (costs_.size() > static_cast<std::size_t>(settings_.history)) costs_.pop_front();
}

Status StatusMonitor::judge(const StatusMeasures& measures) {
  const Status status = decide(measures);
  constexpr int kAtOnce = 1000;  // a tracked scene stays tracked
  const bool would_do = measures.probability >= settings_.thresholds.tracked_above;
  steady_ = status == Status::tracked ? kAtOnce : would_do ? steady_ + 1 : 0;
  if (status == Status::tracked) ever_tracked_ = true;
  return status;
}

Status StatusMonitor::decide(const StatusMeasures& measures) {
  if (!measures.in_view) return Status::absent;
  // The cost may be meaningless off the foreground: pixels off the mask may weigh nothing.
  if (!std::isfinite(measures.cost) || measures.visible < settings_.min_visible ||
      measures.sigma > settings_.lost_sigma ||
      measures.foreground_overlap == ForegroundOverlap::nowhere ||
      (measures.probability < settings_.thresholds.uncertain_above && !measures.detected)) {
    uncertain_in_a_row_ = settings_.patience;
    return Status::lost;
  }
  if (std::isnan(measures.probability)) return judge_by_cost(measures);
  const double enough =
      measures.confirmed ? std::min(needed(), settings_.thresholds.confirmed_above) : needed();
  const bool doubtful = measures.probability < enough ||
                        measures.visible < 2 * settings_.min_visible ||
                        measures.foreground_overlap == ForegroundOverlap::in_parts ||
                        measures.sigma > settings_.uncertain_sigma;
  if (doubtful) return Status::uncertain;
  remember(measures.cost);
  return Status::tracked;
}

Status StatusMonitor::judge_by_cost(const StatusMeasures& measures) {
  const double usual = usual_cost();
  const bool outlier = std::isfinite(usual) && measures.cost > usual;
  // Remember outliers, too: another posture may change the cost for good, and must become the usual
  // cost.
  remember(measures.cost);
  if (outlier || measures.visible < 2 * settings_.min_visible ||
      measures.foreground_overlap == ForegroundOverlap::in_parts)
    return ++uncertain_in_a_row_ >= settings_.patience ? Status::lost : Status::uncertain;
  uncertain_in_a_row_ = 0;
  // A sigma that stays large, as of hidden limbs, does not make a model lost.
  return measures.sigma > settings_.uncertain_sigma ? Status::uncertain : Status::tracked;
}

}  // namespace hypotrack::internal
