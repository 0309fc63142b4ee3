#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/renderer.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// Style of a solution drawn on an image.
struct OverlayStyle {
  double opacity = 0.5;           ///< of the models; 0 = outlines only
  bool contours = true;           ///< outline every model, also in front of another or itself
  std::vector<bool> hidden = {};  ///< for each model, true to leave it out; empty = none
};

/// Draws the scene in `state` on a copy of `image` (8-bit BGR of the camera's size). Every model
/// has its own colour, half transparent, lightly shaded and outlined. `renderer` must be one of
/// `scene`. Throws DataError as Renderer::render does.
HYPOTRACK_API cv::Mat draw_overlay(Renderer& renderer, const Scene& scene, const cv::Mat& image,
                                   const Camera& camera, const Eigen::VectorXd& state,
                                   const OverlayStyle& style = {});

}  // namespace hypotrack
