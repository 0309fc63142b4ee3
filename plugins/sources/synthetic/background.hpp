#pragma once

#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/renderer.hpp"
#include "params.hpp"

namespace hypotrack::synthetic {

/// Renders the background of every camera, one view per camera. A wall and its clutter are surfaces
/// in the world, so the views agree; a plain colour has no depth. Throws DataError if the picture
/// cannot be read or the wall is not in front of the cameras.
std::vector<RenderedView> draw_backgrounds(const BackgroundParams& params,
                                           const std::vector<Camera>& cameras);

}  // namespace hypotrack::synthetic
