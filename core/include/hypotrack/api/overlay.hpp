#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {

/// Returns a displayable image of a view, 8-bit BGR: its colour (shared, not copied), else its
/// depth in grey. Nearer depth is brighter; unmeasured depth is black. Empty if the view has
/// neither.
HYPOTRACK_API cv::Mat picture_of(const View& view);

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
