#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "anatomy.hpp"
#include "field.hpp"

namespace hypotrack::hand_mesh {

/// The hand at its bind pose as an implicit surface: limbs around the bones, soft tissue of the
/// palm and skin between the digits, blended where they grow together and kept apart where they do
/// not.
class HandSurface {
 public:
  HandSurface();

  /// Roughly the signed distance, millimetres, negative inside; zero on the skin.
  double operator()(const Eigen::Vector3d& p) const;
  Eigen::Vector3d gradient(const Eigen::Vector3d& p) const;
  /// The point of the skin that is reached from `p` along the gradient.
  Eigen::Vector3d project(Eigen::Vector3d p) const;

  const std::vector<SkeletonBone>& skeleton() const { return skeleton_; }

 private:
  void add_finger(int digit);
  void add_thumb();
  void add_palm();
  void add_webs();
  double palm(const Eigen::Vector3d& p) const;
  double digit(int digit, const Eigen::Vector3d& p) const;

  struct Web {
    Eigen::Vector3d a, b, c;
    double radius;
  };

  std::vector<SkeletonBone> skeleton_;
  std::array<std::vector<Limb>, kDigits> digits_;
  std::vector<Limb> palm_;
  std::vector<Limb> pads_;
  std::vector<Web> webs_;
};

}  // namespace hypotrack::hand_mesh
