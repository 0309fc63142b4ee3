#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>

#include "base/exported.hpp"
#include "scene/scene_plan.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Poses all vertices of a scene in single precision, in the order of its plan, without allocation.
/// Use one per thread.
class ScenePoser {
 public:
  /// The plan must outlive the poser.
  explicit ScenePoser(const ScenePlan& plan);

  /// Computes the vertices in a camera's frame, metres. `state` must have unit quaternions. A model
  /// with a parameter that is not finite or exceeds 1e6 collapses to the camera's centre. Throws
  /// PluginError if a model that poses itself returns another number of vertices than its mesh has.
  void pose(std::span<const double> state, const Eigen::Isometry3d& camera_from_world);

  /// Return the coordinates of plan.vertex_count vertices, aligned for vectors, valid until the
  /// next call. Padding in a part's last block repeats one of its vertices.
  const float* x() const { return x_.get(); }
  const float* y() const { return y_.get(); }
  const float* z() const { return z_.get(); }

 private:
  void pose_itself(const ScenePlan::Posed& posed, std::span<const double> parameters,
                   const Eigen::Isometry3f& camera_from_world);
  void fill_up_blocks();

  const ScenePlan* plan_;
  BonePoser::Workspace bones_;
  AlignedFloats matrices_, x_, y_, z_;
  Eigen::Matrix3Xf posed_vertices_;
  Eigen::Matrix3Xd posed_landmarks_;
};

}  // namespace internal
}  // namespace hypotrack
