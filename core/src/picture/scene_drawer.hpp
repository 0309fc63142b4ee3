#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hypotrack/observation.hpp"
#include "hypotrack/renderer.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// The nearest surface at the pixels' centres.
struct Geometry {
  cv::Mat depth;  ///< 32-bit float z in metres, 0: nothing there
  cv::Mat label;  ///< 8-bit, 0: nothing, otherwise 1 + index of the model
};

/// RGB in [0, 1] of a model drawn without its texture, by its index in the scene.
Eigen::Vector3f flat_color(int model_index);

/// Holds the OpenGL side of a scene and draws it for pinhole cameras.
class SceneDrawer {
 public:
  /// The scene must outlive the drawer. Throws DeviceError if no context can be made.
  explicit SceneDrawer(const Scene& scene);
  ~SceneDrawer();
  SceneDrawer(const SceneDrawer&) = delete;
  SceneDrawer& operator=(const SceneDrawer&) = delete;

  /// Poses the scene for the draws that follow, which leave `hidden` models out (empty: none).
  void pose(const Eigen::VectorXd& state, const std::vector<bool>& hidden = {});

  /// Where the posed scene lies in the image plane at z = 1 of a camera: the box of (x / z, y / z).
  /// Empty if nothing is in front of the camera, infinite if a part of the scene is at or behind
  /// it.
  Eigen::AlignedBox2d extent(const Eigen::Isometry3d& camera_from_world) const;

  /// Draws the posed scene antialiased: 8-bit BGRA, colour times coverage and coverage (0 .. 255).
  /// Throws DeviceError on sizes beyond what OpenGL can do.
  cv::Mat draw_color(const TileCamera& camera, const RenderStyle& style);

  /// Draws depth and labels of the posed scene. Throws DeviceError like draw_color().
  Geometry draw_geometry(const TileCamera& camera);

  const std::string& device() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
