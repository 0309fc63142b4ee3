#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Directions from a surface to two cameras: unit vectors in the world.
struct ViewDirections {
  Eigen::Vector3d first, other;
};

/// Models the brightness difference that highlights cause between two views of one surface. A
/// highlight lies where the surface's normal halves the angle between light and camera, so each
/// camera sees it elsewhere. Colour matching would turn surfaces until the highlights coincide. The
/// light comes from many directions l with learned strengths a >= 0. It is reflected by Blinn's
/// model (Blinn, "Models of light reflection for computer synthesized pictures", 1977):
///
///   first view - other view = sum over l of a_l (max(0, n h_first)^s - max(0, n h_other)^s),
///
/// n is the normal, h are the unit vectors half way between l and each camera, s = 32.
class Highlights {
 public:
  /// `kept` is the factor by which each call of learn() fades what was learned before. With the
  /// default it fades to about a third (0.4) in 30 calls.
  explicit Highlights(float kept = 0.97F) : kept_(kept) {}

  /// Learns from the brightness differences of the views, 0 .. 255 (N), at points with given
  /// normals (3xN, outward unit vectors in the world). Differences far from the expected ones count
  /// less, as they come from wrong poses.
  void learn(const Eigen::Matrix3Xf& normals, const Eigen::VectorXf& differences,
             const ViewDirections& to);

  /// Returns the expected brightness of the first view minus the other's at points with given
  /// normals (N); 0 before learn().
  Eigen::VectorXf expected(const Eigen::Matrix3Xf& normals, const ViewDirections& to) const;

  /// Restarts learning. The strengths stay as they are until the next learn().
  void forget();

 private:
  float kept_;
  Eigen::MatrixXf products_;  ///< of the lights' differences, summed over samples (L x L)
  Eigen::VectorXf sums_;      ///< of the lights' differences and the observed ones (L)
  Eigen::VectorXf strength_;  ///< of the lights (L)
};

}  // namespace internal
}  // namespace hypotrack
