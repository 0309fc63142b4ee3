#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"
#include "viewing/live_frame.hpp"

namespace hypotrack {

/// Scales a camera so that its image just fits into a size.
Camera fitted(Camera camera, cv::Size limit);

/// How the views are put together.
enum class ViewLayout { row, column };

/// Puts pictures beside or below each other, on black where their sizes differ.
cv::Mat joined(const std::vector<cv::Mat>& pictures, ViewLayout layout);

/// Draws the models on all views. `renderer` must be one of `scene`. `cameras`: those of the
/// source, scaled as the pictures shall be. Models whose pose is unknown are left out.
std::vector<cv::Mat> draw_views(Renderer& renderer, const Scene& scene, const ShownViews& shown,
                                const std::vector<Camera>& cameras);

/// Lowers the priority of the calling thread, and of those it will start, so that drawing takes
/// processor time only where the tracker leaves some.
void yield_to_others();

}  // namespace hypotrack
