#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// World positions of the true landmarks (3xL, metres; NaN columns are unknown), nothing if the frame
/// has no truth.
HYPOTRACK_API std::optional<Eigen::Matrix3Xd> true_landmarks(const Scene& scene,
                                                             const Frame& frame);

/// The paper's error of one frame in metres: distance per landmark, averaged over the landmarks of a
/// model (those with a known truth), then over the models. NaN if no landmark has a truth.
HYPOTRACK_API double mean_landmark_error(const Scene& scene, const Eigen::Matrix3Xd& landmarks,
                                         const Eigen::Matrix3Xd& truth);

inline constexpr std::array<int, 4> kErrorThresholdsMm{5, 10, 20, 40};

/// Errors of a whole run, in millimetres.
struct ErrorStatistics {
  double mean = 0;
  double median = 0;
  std::array<double, kErrorThresholdsMm.size()> fraction_below{};
};

/// Statistics of per-frame errors in metres (NaN entries are left out); nothing if none remain.
HYPOTRACK_API std::optional<ErrorStatistics> error_statistics(const std::vector<double>& errors);

}  // namespace hypotrack
