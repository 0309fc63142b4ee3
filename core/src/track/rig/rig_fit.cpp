#include "track/rig/rig_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kFrames = 12;  // remembered: some seconds

double square(double x) { return x * x; }

/// Returns the factors of rows, roll and scale in a match's residual.
Eigen::Vector3d factors(const RowMatch& match) { return {1, match.at.x(), match.at.y()}; }

}  // namespace

void RigFit::add(const std::vector<RowMatch>& matches) {
  if (matches.empty()) return;
  frames_.push_back(matches);
  if (frames_.size() > kFrames) frames_.pop_front();
}

RigEstimate RigFit::estimate() const {
  constexpr int kPasses = 12;
  constexpr double kRounding = 0.1;  // pixels: no match is better
  // Patches overlap and share what disturbs them: so many count as one.
  constexpr double kShared = 4;
  constexpr double kOutlier = 3;  // standard deviations, where a weight falls to a half
  std::vector<RowMatch> all;
  for (const auto& frame : frames_) all.insert(all.end(), frame.begin(), frame.end());
  RigEstimate out;
  out.matches = static_cast<int>(all.size());
  if (all.empty()) return out;
  // Standard deviations before any match: pixels, radians, a share.
  const Eigen::Vector3d unknown(30, 0.1, 0.1);
  const Eigen::Matrix3d prior = unknown.cwiseAbs2().cwiseInverse().asDiagonal();
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero(), spread = covariance;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<double> off;
    for (const RowMatch& m : all) off.push_back(std::abs(m.residual - factors(m).dot(value)));
    const double sigma = std::hypot(1.4826 * upper_median(off), kRounding);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double weights = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double weight = 1 / (1 + square(off[i] / (kOutlier * sigma)));
      const Eigen::Vector3d row = factors(all[i]);
      normal += weight * row * row.transpose();
      right += weight * all[i].residual * row;
      weights += weight;
    }
    const double noise = kShared * square(sigma);
    covariance = (normal / noise + prior).inverse();
    value = covariance * right / noise;
    spread = normal / weights;
  }
  out.rows = value[0];
  out.roll = value[1];
  out.scale = value[2];
  out.row_error = std::sqrt(std::max(0.0, value.dot(spread * value)));
  out.row_error_sigma = std::sqrt((spread * covariance).trace());
  return out;
}

}  // namespace hypotrack::internal
