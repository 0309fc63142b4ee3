#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"
#include "picture/lens.hpp"
#include "picture/surface.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Near clipping distance in metres: a projection has no meaning at the camera's centre.
inline constexpr double kNearest = 1e-3;

/// Returns the bounding box of vertices (3xV each, world) in the plane z = 1 of a camera:
/// (x / z, y / z). Empty if nothing is in front of the camera; infinite if some of them are at or
/// behind it.
Eigen::AlignedBox2d extent_of(std::span<const Eigen::Matrix3Xf> vertices,
                              const Eigen::Isometry3d& camera_from_world);

/// Returns the colour (RGB in [0, 1]) of a model drawn without texture, by its index in the scene.
Eigen::Vector3f flat_color(int model_index);

/// Draws a scene in flat, shaded colours on the CPU, with the rasteriser of hypotheses.
class FlatDrawer {
 public:
  /// The scene must outlive the drawer.
  explicit FlatDrawer(const Scene& scene);
  ~FlatDrawer();
  FlatDrawer(const FlatDrawer&) = delete;
  FlatDrawer& operator=(const FlatDrawer&) = delete;

  /// Draws a state over `rendered`, a picture of the camera's size without depth and labels.
  void draw(const Eigen::VectorXd& state, const LensRays& lens,
            const Eigen::Isometry3d& camera_from_world, const RenderStyle& style,
            RenderedView& rendered);

 private:
  struct Solo;

  Surface draw_surface(const std::vector<std::size_t>& shown, const Eigen::VectorXd& state,
                       const TileCamera& camera);

  const Scene& scene_;
  std::vector<std::unique_ptr<Solo>> solos_;  ///< by model
};

}  // namespace internal
}  // namespace hypotrack
