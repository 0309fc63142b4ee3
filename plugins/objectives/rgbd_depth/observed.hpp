#pragma once

namespace hypotrack::rgbd_depth {

/// Special values of an observation, which otherwise is z of the foreground in metres. Their
/// distance from any depth exceeds all thresholds on depth differences.
inline constexpr float kUnmeasured = -1e6f;  ///< foreground without a depth
inline constexpr float kBackground = -2e6f;  ///< not foreground, whatever its depth
inline constexpr float kOutside = -3e6f;     ///< outside the image

}  // namespace hypotrack::rgbd_depth
