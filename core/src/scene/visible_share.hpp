#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "camera/rectification.hpp"
#include "hypotrack/api/camera.hpp"
#include "scene/posed_scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Computes how much of a scene its cameras see, ignoring occlusion.
class VisibleShare {
 public:
  /// Takes the cameras, at least one, and their rig.
  VisibleShare(std::span<const Camera> cameras, const IdealRig& rig);

  /// Returns the share of the models' vertices that every image shows. Models that the scene leaves
  /// out do not count. Returns 0 if any vertex lies at or behind a camera, so that no tile exists.
  /// The scene must be posed for the same rig.
  double of(const PosedScene& scene) const;

 private:
  /// A camera, relative to the first ideal one.
  struct SeenBy {
    Camera camera;
    Eigen::Matrix3d camera_from_ideal;  ///< from its own ideal camera
    Eigen::Matrix<float, 3, 4> camera_from_first;
    std::array<float, 19> distortion;
    float fx, fy, cx, cy;
    float right, bottom;  ///< upper bounds of the image's coordinates
  };

  bool shown_entirely(const PosedScene& scene) const;
  static bool keep_shown(const SeenBy& view, const ScenePoser& vertices, std::size_t first,
                         Eigen::Array<bool, kBlock, 1>& mask);

  std::vector<SeenBy> views_;
};

/// Returns true only if the camera's image surely shows everything within an ideal camera's bounds,
/// except the image's outermost pixel. False proves nothing. The ideal camera is at the same place;
/// `camera_from_ideal` is a rotation.
bool surely_shown(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal,
                  const Bounds& bounds);

}  // namespace internal
}  // namespace hypotrack
