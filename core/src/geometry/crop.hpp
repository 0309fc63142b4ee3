#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "evaluate/scene_poser.hpp"
#include "geometry/rectification.hpp"
#include "hypotrack/observation.hpp"

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

/// Where the posed scene lies in the ideal cameras. Reuses its memory: one per thread.
class SceneBounds {
 public:
  /// The scene and the rig must outlive it.
  SceneBounds(const Scene& scene, const IdealRig& rig);

  /// One per camera. Throws DataError if the scene posed in `state` lies at or behind one.
  std::vector<Bounds> of(const Eigen::VectorXd& state);

 private:
  const Scene& scene_;
  ScenePlan plan_;
  ScenePoser poser_;
  Eigen::Isometry3d first_from_world_;
  std::vector<Eigen::Matrix<float, 3, 4>> ideal_from_first_;
  Eigen::VectorXd state_;
};

/// The tiles of size x size pixels around bounds, with a margin on each side as a share of the
/// larger extent, none wider than `largest_focal` pixels at z = 1. Tiles of a rectified pair share
/// rows and scale.
std::vector<TileCamera> crop(std::vector<Bounds> bounds, const IdealRig& rig, int size,
                             double padding, double largest_focal);

}  // namespace hypotrack
