#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/scene.hpp"
#include "viewing/live_frame.hpp"

namespace hypotrack {

/// What the preview's window says of a run.
struct PreviewText {
  std::vector<std::string> models;  ///< names
  std::optional<LiveFrame> newest;
  std::optional<int> frames;  ///< of the whole run, if known
  LiveStatus status;
  std::string message;  ///< shown in place of the keys if there is one
  bool help = false;
};

/// Returns the size of the window in which views and text fit on a screen.
cv::Size preview_size(const std::vector<Camera>& cameras, std::size_t models, cv::Size screen);

/// Scales cameras so that their views fit side by side above the text.
std::vector<Camera> preview_cameras(const std::vector<Camera>& cameras, std::size_t models,
                                    cv::Size area);

/// Draws a window's picture: the views side by side, the numbers of the newest frame below them.
/// `views`: of the cameras that preview_cameras() returns; empty: none yet.
cv::Mat preview_picture(const std::vector<cv::Mat>& views, const PreviewText& text, cv::Size area);

}  // namespace hypotrack
