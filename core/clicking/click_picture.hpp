#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "clicking/clicker.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/renderer.hpp"

namespace hypotrack::clicking {

/// Draws the first two views of a frame side by side with the fit, the marks, the guiding lines and
/// the text below. `renderer` must be one of `scene`.
cv::Mat draw_clicks(Renderer& renderer, const Scene& scene, const std::vector<Camera>& cameras,
                    const Frame& frame, const ClickDrawing& drawing);

}  // namespace hypotrack::clicking
