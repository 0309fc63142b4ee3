#include "track/one_euro.hpp"

#include <numbers>

#include "track/tangent.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the low-pass filter's weight of a new value (Eq. 3 of the paper, for a sampling
/// interval).
double weight_of(double cutoff, double seconds) {
  const double r = 2 * std::numbers::pi * cutoff * seconds;
  return r / (r + 1);
}

}  // namespace

OneEuroFilter::OneEuroFilter(const Scene& scene, const OneEuroSettings& settings)
    : scene_(&scene), settings_(settings) {}

Eigen::VectorXd OneEuroFilter::filter(const Eigen::VectorXd& state, double time) {
  const double seconds = time - time_;
  time_ = time;
  if (state_.size() == 0 || !(seconds > 0)) {
    speed_.resize(0);
    return state_ = found_ = state;
  }
  const Eigen::VectorXd speed = difference(*scene_, found_, state) / seconds;
  if (speed_.size() == 0) speed_.setZero(speed.size());
  speed_ += weight_of(settings_.speed_cutoff, seconds) * (speed - speed_);

  Eigen::VectorXd step = difference(*scene_, state_, state);
  for (const TangentPart& part : tangent_parts(*scene_)) {
    auto steps = step.segment(part.first, part.size);
    const auto speeds = speed_.segment(part.first, part.size);
    const double beta = is_in_metres(part.kind) ? settings_.position_beta : settings_.angle_beta;
    if (is_joint(part.kind)) {
      for (Eigen::Index i = 0; i < part.size; ++i) {
        steps[i] *= weight_of(cutoff(beta, std::abs(speeds[i])), seconds);
      }
      continue;
    }
    steps *= weight_of(cutoff(beta, speeds.norm()), seconds);
  }
  found_ = state;
  return state_ = moved(*scene_, state_, step);
}

}  // namespace hypotrack::internal
