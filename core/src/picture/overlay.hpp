#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/renderer.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// How a solution is drawn on an image.
struct OverlayStyle {
  double opacity = 0.5;  ///< of the models; 0: outlines only
  bool contours = true;  ///< outline every model, also where it lies before another or itself
  std::vector<bool> hidden = {};  ///< for each model, whether it is left out; empty: none
};

/// Draws the scene in `state` on a copy of `image` (8-bit BGR of the camera's size): every model in
/// a colour of its own, lightly shaded so that its shape can be read, half transparent, outlined.
/// `renderer` must be one of `scene`. Throws DataError where Renderer::render does.
HYPOTRACK_API cv::Mat draw_overlay(Renderer& renderer, const Scene& scene, const cv::Mat& image,
                                   const Camera& camera, const Eigen::VectorXd& state,
                                   const OverlayStyle& style = {});

}  // namespace hypotrack
