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

Status StatusMonitor::judge(const StatusEvidence& evidence) {
  const Status status = decide(evidence);
  constexpr int kAtOnce = 1000;  // a tracked scene stays tracked
  const bool would_do = evidence.probability >= settings_.thresholds.tracked_above;
  steady_ = status == Status::tracked ? kAtOnce : would_do ? steady_ + 1 : 0;
  if (status == Status::tracked) ever_tracked_ = true;
  return status;
}

Status StatusMonitor::decide(const StatusEvidence& evidence) {
  if (!evidence.in_view) return Status::absent;
  // The cost may be meaningless off the foreground: pixels off the mask may weigh nothing.
  if (!std::isfinite(evidence.cost) || evidence.visible < settings_.min_visible ||
      evidence.sigma > settings_.lost_sigma ||
      evidence.foreground_overlap == ForegroundOverlap::nowhere ||
      (evidence.probability < settings_.thresholds.uncertain_above && !evidence.recognized)) {
    uncertain_in_a_row_ = settings_.patience;
    return Status::lost;
  }
  if (std::isnan(evidence.probability)) return judge_by_cost(evidence);
  const double enough =
      evidence.confirmed ? std::min(needed(), settings_.thresholds.confirmed_above) : needed();
  const bool doubtful = evidence.probability < enough ||
                        evidence.visible < 2 * settings_.min_visible ||
                        evidence.foreground_overlap == ForegroundOverlap::in_parts ||
                        evidence.sigma > settings_.uncertain_sigma;
  if (doubtful) return Status::uncertain;
  remember(evidence.cost);
  return Status::tracked;
}

Status StatusMonitor::judge_by_cost(const StatusEvidence& evidence) {
  const double usual = usual_cost();
  const bool outlier = std::isfinite(usual) && evidence.cost > usual;
  // Remember outliers, too: another posture may change the cost for good, and must become the usual
  // cost.
  remember(evidence.cost);
  if (outlier || evidence.visible < 2 * settings_.min_visible ||
      evidence.foreground_overlap == ForegroundOverlap::in_parts)
    return ++uncertain_in_a_row_ >= settings_.patience ? Status::lost : Status::uncertain;
  uncertain_in_a_row_ = 0;
  // A sigma that stays large, as of hidden limbs, does not make a model lost.
  return evidence.sigma > settings_.uncertain_sigma ? Status::uncertain : Status::tracked;
}

}  // namespace hypotrack::internal
