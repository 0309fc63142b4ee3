#pragma once

#include <filesystem>
#include <vector>

#include "picture/start_picture.hpp"
#include "session/opened_scene.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack::app {

/// Throws ConfigError or OutputError if a picture cannot be written there as PNG.
void check_picture_file(const std::filesystem::path& file);

/// Writes a picture as PNG, as a whole or not at all. Throws OutputError.
void write_picture(const std::filesystem::path& file, const cv::Mat& picture);

/// Returns a start that gives a state, with a caption that names it.
StartToDraw given_start(const OpenedScene& session, const Eigen::VectorXd& state,
                        const Frame& frame);

/// Looks for the models in a frame as a run does. Returns what was found, with a caption that says
/// so; without a state if nothing was.
StartToDraw found_start(const OpenedScene& session, SceneTracker& tracker, const Frame& frame);

}  // namespace hypotrack::app
