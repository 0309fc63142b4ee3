#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/camera.hpp"
#include "params.hpp"

namespace hypotrack::synthetic {

/// What every camera sees behind the models: 8-bit BGR, one image per camera. A wall and its
/// clutter are surfaces in the world, so the views agree. Throws DataError if the picture cannot be
/// read or the wall is not in front of the cameras.
std::vector<cv::Mat> draw_backgrounds(const BackgroundParams& params,
                                      const std::vector<Camera>& cameras);

}  // namespace hypotrack::synthetic
