#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Depth and label of the nearest surface at pixel centres.
struct Geometry {
  cv::Mat depth;  ///< 32-bit float z in metres; 0 = nothing
  cv::Mat label;  ///< 8-bit; 0 = nothing, else 1 + index of the model
};

/// Owns the OpenGL objects of a scene and draws it for pinhole cameras.
class SceneDrawer {
 public:
  /// The scene must outlive the drawer. Throws DeviceError if no context can be made.
  explicit SceneDrawer(const Scene& scene);
  ~SceneDrawer();
  SceneDrawer(const SceneDrawer&) = delete;
  SceneDrawer& operator=(const SceneDrawer&) = delete;

  /// Poses the scene for the next draws; they leave out `hidden` models (empty: none).
  void pose(const Eigen::VectorXd& state, const std::vector<bool>& hidden = {});

  /// Returns extent_of() the posed scene.
  Eigen::AlignedBox2d extent(const Eigen::Isometry3d& camera_from_world) const;

  /// Draws the posed scene antialiased: 8-bit BGRA with colour times coverage, and coverage (0 ..
  /// 255). Throws DeviceError on sizes beyond OpenGL's limits.
  cv::Mat draw_color(const TileCamera& camera, const RenderStyle& style);

  /// Draws depth and labels of the posed scene. Throws DeviceError as draw_color() does.
  Geometry draw_geometry(const TileCamera& camera);

  const std::string& device() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack
