#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "camera/rectification.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "scene/scene_poser.hpp"

namespace hypotrack {

/// A rectangle on the plane z = 1 of an ideal camera.
struct Bounds {
  float x0 = std::numeric_limits<float>::infinity();
  float x1 = -x0;
  float y0 = x0;
  float y1 = -x0;

  double width() const { return double{x1} - x0; }
  double height() const { return double{y1} - y0; }
};

/// A scene posed before the ideal cameras of a rig, and where they see it. Knows the state that it
/// posed last: the solution of a frame is where the tiles of the next one are cut. Reuses its
/// memory: one per thread.
class HYPOTRACK_API PosedScene {
 public:
  /// The scene must outlive it.
  PosedScene(const Scene& scene, const IdealRig& rig);

  /// Costs a comparison if the state is the last one. Throws as ScenePoser::pose() does.
  void pose(const Eigen::VectorXd& state);

  /// Leaves models out of bounds and checks from now on. One flag per model of the scene, not all
  /// set.
  void leave_out(const std::vector<bool>& models);
  bool leaves_out(const ScenePlan::Part& part) const {
    return left_out_[static_cast<std::size_t>(&part - plan_.parts.data())];
  }

  const ScenePlan& plan() const { return plan_; }
  /// In the frame of the first ideal camera.
  const ScenePoser& vertices() const { return poser_; }

  /// Whether everything lies in front of every ideal camera.
  bool in_front() const { return behind_.part == nullptr; }
  /// Throws DataError, naming model and camera, unless it does.
  void check_in_front() const;
  /// One rectangle around the vertices for every ideal camera. Only if all lie in front.
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
  bool posed_ = false;          ///< in the state that was given last
  Eigen::VectorXd given_;       ///< the state as it was given
  Eigen::VectorXd normal_;      ///< normalised
  std::vector<Bounds> bounds_;
  Behind behind_;
};

}  // namespace hypotrack
