#pragma once

#include <Eigen/Core>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Where two cameras are, from a surface: unit vectors in the world.
struct ViewDirections {
  Eigen::Vector3d first, other;
};

/// What highlights make two views of one surface differ by. A highlight lies where the surface's
/// normal halves the angle between light and camera, so each camera sees it elsewhere, and a match
/// of colours turns surfaces until highlights lie on each other. The light is taken to come from
/// many directions l, with strengths a >= 0 that are learned, and to be reflected as Blinn's model
/// has it (Blinn, "Models of light reflection for computer synthesized pictures", 1977):
///
///   first view - other view = sum over l of a_l (max(0, n h_first)^s - max(0, n h_other)^s),
///
/// n the normal, h the unit vectors half way between l and each camera, s = 32.
class HYPOTRACK_API Highlights {
 public:
  /// `kept` is the share of what was learned that still counts one call later: what was learned
  /// some 30 calls ago counts a third unless it is said otherwise.
  explicit Highlights(float kept = 0.97F) : kept_(kept) {}

  /// Takes in what the views differed by, 0 .. 255 (N), at points of normals (3xN, unit vectors in
  /// the world, outwards). Differences that are far from what is expected, as where the pose was
  /// wrong, count less.
  void learn(const Eigen::Matrix3Xf& normals, const Eigen::VectorXf& differences,
             const ViewDirections& to);

  /// By how much the first view is expected to be brighter at such points (N); 0 before learn().
  Eigen::VectorXf expected(const Eigen::Matrix3Xf& normals, const ViewDirections& to) const;

  /// Learns anew from here on; until then the lights stay as they are.
  void forget();

 private:
  float kept_;
  Eigen::MatrixXf products_;  ///< of the lights' differences, over samples (L x L)
  Eigen::VectorXf sums_;      ///< of those times what was seen (L)
  Eigen::VectorXf strength_;  ///< of the lights (L)
};

}  // namespace hypotrack
