#include "track/rig/delay_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "hypotrack/median.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kFewestFrames = 10;

/// Fits rows = offset - delay speed, robustly.
Delay fit_delay(std::span<const RowMotion> frames) {
  constexpr int kPasses = 8;
  // No frame tells rows better: half a pixel of a focal length of 1000.
  constexpr double kRounding = 0.0005;
  constexpr double kShared = 2;   // neighbouring frames share errors: so many count as one
  constexpr double kOutlier = 3;  // standard deviations, where a weight falls to a half
  const Eigen::Vector2d unknown(0.01, 0.2);
  const Eigen::Matrix2d prior = unknown.cwiseAbs2().cwiseInverse().asDiagonal();
  Eigen::Vector2d value = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<double> off;
    for (const RowMotion& f : frames)
      off.push_back(std::abs(f.rows - Eigen::Vector2d(1, -f.speed).dot(value)));
    const double sigma = std::hypot(1.4826 * upper_median(off), kRounding);
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const double outlying = off[i] / (kOutlier * sigma);
      const double weight = 1 / (1 + outlying * outlying);
      const Eigen::Vector2d row(1, -frames[i].speed);
      normal += weight * row * row.transpose();
      right += weight * frames[i].rows * row;
    }
    const double noise = kShared * sigma * sigma;
    covariance = (normal / noise + prior).inverse();
    value = covariance * right / noise;
  }
  return {value[1], std::sqrt(covariance(1, 1))};
}

/// Returns whether a delay has a sign, is at least so long, and so many standard deviations.
bool is_sure(const Delay& delay, double sign, double least, double sigmas) {
  return sign * delay.seconds > std::max(least, sigmas * delay.sigma);
}

}  // namespace

void DelayFit::add(const RowMotion& motion) {
  constexpr double kSeconds = 4;  // remembered
  frames_.push_back(motion);
  while (motion.time - frames_.front().time > kSeconds) frames_.pop_front();
}

Delay DelayFit::estimate() const {
  if (frames_.size() < kFewestFrames) return {0, std::numeric_limits<double>::infinity()};
  const std::vector<RowMotion> all(frames_.begin(), frames_.end());
  return fit_delay(all);
}

std::optional<Delay> DelayFit::beyond(double least) const {
  constexpr double kSure = 2.5, kSureInHalf = 1.2;  // standard deviations
  constexpr double kLeastSeconds = 0.6;
  if (frames_.size() < kFewestFrames || frames_.back().time - frames_.front().time < kLeastSeconds)
    return {};
  const std::vector<RowMotion> all(frames_.begin(), frames_.end());
  const std::span<const RowMotion> span(all);
  const std::size_t half = all.size() / 2;
  const Delay delay = fit_delay(span);
  const double sign = delay.seconds < 0 ? -1 : 1;
  const bool sure = is_sure(delay, sign, least, kSure) &&
                    is_sure(fit_delay(span.first(half)), sign, least / 2, kSureInHalf) &&
                    is_sure(fit_delay(span.subspan(half)), sign, least / 2, kSureInHalf);
  return sure ? std::optional(delay) : std::nullopt;
}

}  // namespace hypotrack::internal
