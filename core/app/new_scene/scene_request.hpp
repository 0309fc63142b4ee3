#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera_source.hpp"

namespace hypotrack::app {

/// Pictures, videos or live pictures of a pair of cameras, and their calibration.
struct RecordingFiles {
  std::filesystem::path left, right;       ///< patterns of pictures, single pictures, or videos
  std::filesystem::path side_by_side;      ///< one video of both views, instead of those
  std::optional<std::string> layout = {};  ///< of both views in `side_by_side`, or in `left` alone
  std::optional<CameraOptions> live;       ///< live cameras, instead of all those
  std::filesystem::path calibration;       ///< empty: not found
  std::filesystem::path extrinsics;        ///< second file of the calibration; may be empty
};

/// Everything that a new scene is made of.
struct SceneRequest {
  RecordingFiles recording;
  std::vector<std::string> cameras;  ///< of the calibration; empty: all
  std::string units;                 ///< of the calibration; empty: what its file says
  std::optional<double> scale;       ///< of the calibration
  std::string model;                 ///< hand, left_hand, two_hands, hand_and_box or box
  Eigen::Vector3d box_mm{0, 0, 0};
  std::string tracker;  ///< real, recommended, real_time or rigid
};

/// Returns the scene as YAML. Paths are relative to `folder`, the scene's, if they lie near it.
/// Throws ConfigError if the tracker cannot track the models.
std::string scene_text(const SceneRequest& request, const std::filesystem::path& folder);

}  // namespace hypotrack::app
