#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "camera/rectification.hpp"
#include "hypotrack/api/scene.hpp"
#include "scene/scene_poser.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A rectangle in the plane z = 1 of an ideal camera.
struct Bounds {
  float x0 = std::numeric_limits<float>::infinity();
  float x1 = -x0;
  float y0 = x0;
  float y1 = -x0;

  double width() const { return double{x1} - x0; }
  double height() const { return double{y1} - y0; }
};

/// A scene posed for a rig's ideal cameras, with its image bounds. It caches the last state,
/// because the tiles of a frame are cropped around the previous frame's solution. It reuses its
/// memory; use one per thread.
class PosedScene {
 public:
  /// The scene must outlive this object.
  PosedScene(const Scene& scene, const IdealRig& rig);

  /// Poses the scene; only a comparison if the state is the last one. Throws as ScenePoser::pose()
  /// does.
  void pose(const Eigen::VectorXd& state);

  /// Excludes models from bounds and checks from now on: one flag per model, not all set.
  void leave_out(const std::vector<bool>& models);
  bool leaves_out(const ScenePlan::Part& part) const {
    return left_out_[static_cast<std::size_t>(&part - plan_.parts.data())];
  }

  const ScenePlan& plan() const { return plan_; }
  /// Returns the vertices in the frame of the first ideal camera.
  const ScenePoser& vertices() const { return poser_; }

  /// Returns true if all vertices lie in front of every ideal camera.
  bool in_front() const { return behind_.part == nullptr; }
  /// Throws DataError, naming model and camera, unless in_front().
  void check_in_front() const;
  /// Returns the bounding rectangle of the vertices for every ideal camera. Requires in_front().
  std::span<const Bounds> bounds() const { return bounds_; }

 private:
  using Matrix34 = std::array<float, 12>;  // row-major
  /// The first model found that is not in front of a camera.
  struct Behind {
    const ScenePlan::Part* part = nullptr;
    std::size_t view = 0;
    float nearest = 0;
  };

  void find_bounds();

  const Scene& scene_;
  ScenePlan plan_;
  ScenePoser poser_;
  Eigen::Isometry3d first_from_world_;
  std::vector<Matrix34> ideal_from_first_;
  std::vector<bool> left_out_;  ///< one per part
  bool posed_ = false;          ///< in the state `given_`
  Eigen::VectorXd given_;       ///< the state before normalisation
  Eigen::VectorXd normal_;      ///< normalised
  std::vector<Bounds> bounds_;
  Behind behind_;
};

}  // namespace internal
}  // namespace hypotrack
