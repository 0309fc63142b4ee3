#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/renderer.hpp"
#include "params.hpp"

namespace hypotrack::synthetic {

/// Renders the background of every camera, one view per camera. A wall and its clutter are surfaces
/// in the world, so the views agree; a plain colour has no depth. Throws DataError if the picture
/// cannot be read or the wall is not in front of the cameras. A person is drawn over the rest in
/// `light`, with skin of the colour `skin` (red, green, blue) unless the parameters have another.
/// Throws ConfigError, naming `where`, if the person is behind the wall.
std::vector<RenderedView> draw_backgrounds(const BackgroundParams& params,
                                           const std::vector<Camera>& cameras,
                                           const RenderStyle& light, const Eigen::Vector3d& skin,
                                           const std::string& where);

}  // namespace hypotrack::synthetic
