#include "track/rig/rig_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hypotrack/median.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kFrames = 12;  // remembered: some seconds
constexpr double kRounding = 0.1;    // pixels: no match is better
// Patches overlap and share what disturbs them: so many count as one.
constexpr double kShared = 4;

double square(double x) { return x * x; }

}  // namespace

void RigFit::add(std::vector<RowMatch> matches, double seconds) {
  if (matches.empty()) return;
  std::vector<Row>& rows = frames_.emplace_back();
  for (const RowMatch& m : matches)
    rows.push_back(
        {{1, m.at.x(), m.at.y(), seconds > 0 ? -m.motion.y() / seconds : 0}, m.residual});
  if (frames_.size() > kFrames) frames_.pop_front();
}

RigEstimate RigFit::estimate() const {
  constexpr int kPasses = 12;
  constexpr double kOutlier = 3;  // standard deviations, where a weight falls to a half
  std::vector<Row> all;
  for (const auto& frame : frames_) all.insert(all.end(), frame.begin(), frame.end());
  RigEstimate out;
  out.matches = static_cast<int>(all.size());
  if (all.empty()) return out;
  // Standard deviations before any match: pixels, radians, a share, seconds.
  const Eigen::Vector4d unknown(30, 0.1, 0.1, 0.2);
  const Eigen::Matrix4d prior = unknown.cwiseAbs2().cwiseInverse().asDiagonal();
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero(), spread = covariance;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<double> off;
    for (const Row& row : all) off.push_back(std::abs(row.residual - row.factors.dot(value)));
    const double sigma = std::hypot(1.4826 * upper_median(off), kRounding);
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double weights = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double weight = 1 / (1 + square(off[i] / (kOutlier * sigma)));
      normal += weight * all[i].factors * all[i].factors.transpose();
      right += weight * all[i].residual * all[i].factors;
      weights += weight;
    }
    const double noise = kShared * square(sigma);
    covariance = (normal / noise + prior).inverse();
    value = covariance * right / noise;
    spread = normal / weights;
  }
  spread.row(3).setZero();
  spread.col(3).setZero();
  out.rows = value[0];
  out.roll = value[1];
  out.scale = value[2];
  out.delay = value[3];
  out.row_error = std::sqrt(std::max(0.0, value.dot(spread * value)));
  out.row_error_sigma = std::sqrt((spread * covariance).trace());
  out.delay_sigma = std::sqrt(covariance(3, 3));
  return out;
}

}  // namespace hypotrack::internal
