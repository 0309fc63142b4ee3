#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "anatomy.hpp"

namespace hypotrack::hand_mesh {

/// A curve drawn on the palm or the back of the hand, seen along z.
class SkinCurve {
 public:
  /// Through `points` (x, y of the hand frame, mm); `width` is the half width at half strength.
  SkinCurve(std::vector<Eigen::Vector2d> points, double width, double strength);
  /// 0 away from the curve, its strength on it; fades at both ends.
  double operator()(const Eigen::Vector2d& p) const;

 private:
  std::vector<Eigen::Vector2d> points_;
  Eigen::AlignedBox2d box_;
  double width_;
  double strength_;
};

std::vector<SkinCurve> palm_lines();
std::vector<SkinCurve> dorsal_veins();

/// Creases across the digits, from joints bending over a life.
class JointCreases {
 public:
  explicit JointCreases(const std::vector<SkeletonBone>& skeleton);
  /// Strength of creases (0 .. about 1) at a point of the skin; `palmar` is 1 on the palmar side.
  double operator()(const Eigen::Vector3d& p, double palmar) const;
  /// 1 over the back of the knuckles, where skin is redder and loose, 0 elsewhere.
  double knuckle(const Eigen::Vector3d& p) const;

 private:
  struct Joint {
    Eigen::Isometry3d joint_from_hand;  ///< half way between the two bones
    double radius;
    double dorsal_share;                  ///< how much its dorsal folds count
    std::vector<Eigen::Vector3d> palmar;  ///< place along the digit, half width, strength
    std::vector<Eigen::Vector3d> dorsal;
  };
  std::vector<Joint> joints_;
};

}  // namespace hypotrack::hand_mesh
