#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace hypotrack {

/// Joints and fingertips of a hand in a picture, in pixels; pixel centres are at integers.
using HandPoints = Eigen::Matrix<double, 2, 21>;

/// Returns the diagonal of the box around a hand in a picture, in pixels.
inline double size_of(const HandPoints& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

/// Landmarks of a hand in space, metres.
using HandPoints3D = Eigen::Matrix<double, 3, 21>;

/// Names of the columns of HandPoints: the landmarks of hypotrack's hands.
inline constexpr std::array<std::string_view, 21> kHandPointNames = {
    "wrist",     "thumb_cmc", "thumb_mcp",  "thumb_ip",   "thumb_tip",  "index_mcp",  "index_pip",
    "index_dip", "index_tip", "middle_mcp", "middle_pip", "middle_dip", "middle_tip", "ring_mcp",
    "ring_pip",  "ring_dip",  "ring_tip",   "little_mcp", "little_pip", "little_dip", "little_tip"};

/// Returns the landmarks of a hand that people find best: wrist and knuckles, then the tips. They
/// are a hand's Model::clear_landmarks().
inline std::vector<std::string> clear_hand_landmarks() {
  return {"wrist",     "index_mcp", "middle_mcp", "ring_mcp", "little_mcp",
          "thumb_tip", "index_tip", "middle_tip", "ring_tip", "little_tip"};
}

}  // namespace hypotrack
