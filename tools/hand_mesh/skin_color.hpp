#pragma once

#include <Eigen/Core>
#include <vector>

#include "anatomy.hpp"
#include "skin_lines.hpp"

namespace hypotrack::hand_mesh {

/// A place on the skin.
struct SkinPoint {
  Eigen::Vector3d position;  ///< hand frame at the bind pose, mm
  double palmar = 0;         ///< 0 on the back .. 1 on the palmar side
  double openness = 1;
};

/// The colour of skin and nails anywhere on the hand.
class SkinColor {
 public:
  explicit SkinColor(const std::vector<SkeletonBone>& skeleton);
  /// RGB, sRGB-encoded, 0 .. 1.
  Eigen::Vector3d operator()(const SkinPoint& point) const;

 private:
  Eigen::Vector3d skin(const SkinPoint& point) const;
  double relief(const SkinPoint& point) const;
  double redness(const SkinPoint& point) const;
  void add_nails(const SkinPoint& point, Eigen::Vector3d& color) const;

  struct Nail {
    Eigen::Isometry3d bone_from_hand;
    double half_width;
    double start;  ///< along the bone
    double end;
  };

  std::vector<SkinCurve> palm_lines_;
  std::vector<SkinCurve> veins_;
  JointCreases creases_;
  std::vector<Nail> nails_;
  std::vector<Eigen::Vector3d> pulps_;  ///< centres of the finger prints
};

}  // namespace hypotrack::hand_mesh
