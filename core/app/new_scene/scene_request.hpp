#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cameras/camera_source.hpp"

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

/// Reads the edges of a box, `60x120x30mm` or `6x12x3cm`, in millimetres. Throws ConfigError.
Eigen::Vector3d box_size_mm(const std::string& text);

/// Finds the pictures or videos of a pair, and its calibration, in a folder and two levels below.
/// Left and right are told by their names: left and right, or cam0 and cam1. Throws DataError if
/// there is no pair, or more than one.
RecordingFiles find_recording(const std::filesystem::path& folder);

/// Adds the calibration's second file if `intrinsics` and `extrinsics` lie side by side.
void add_extrinsics(RecordingFiles& files);

/// A value of a scene that may be given by an option or asked for.
struct Question {
  std::string option;      ///< for messages: --model
  std::string text;        ///< asked on a terminal
  std::string usual = {};  ///< taken for an empty answer; empty: an answer is needed
};

/// Asks on the terminal until `take` accepts the answer; it throws Error with what is wrong with
/// one. Throws ConfigError, naming the option, if standard input is no terminal or ends.
void ask(const Question& question, const std::function<void(const std::string&)>& take);

}  // namespace hypotrack::app
