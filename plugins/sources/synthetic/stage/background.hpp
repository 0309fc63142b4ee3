#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/plugin/model.hpp"
#include "params.hpp"

namespace hypotrack::synthetic {

/// The background of every camera. A wall and its clutter are surfaces in the world, so the views
/// agree; a plain colour has no depth. A person is drawn over the rest.
class Backgrounds {
 public:
  /// Draws nothing yet: a source may be opened without a look at its frames. A person is drawn in
  /// `light`, with skin of the colour `skin` (red, green, blue) unless the parameters have another.
  /// Throws DataError if the picture cannot be read or the wall is not in front of the cameras, and
  /// ConfigError, naming `where`, if the person is behind the wall.
  Backgrounds(const BackgroundParams& params, const std::vector<Camera>& cameras,
              const RenderStyle& light, const Eigen::Vector3d& skin, const std::string& where);

  /// Returns one view per camera; the first call renders them.
  const std::vector<RenderedView>& views();

 private:
  struct Layer {
    std::vector<Mesh> meshes;
    RenderStyle style;
  };
  std::vector<Camera> cameras_;
  std::vector<Layer> layers_;  ///< not drawn yet, from back to front
  std::vector<RenderedView> views_;
};

}  // namespace hypotrack::synthetic
