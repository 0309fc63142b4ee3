#include "track/motion_limits.hpp"

#include <algorithm>

#include "track/tangent.hpp"

namespace hypotrack::internal {

Reach reach_within(const MotionLimits& limits, double seconds) {
  // Frames with equal or decreasing times count as 1/30 s apart.
  constexpr double kFrame = 1.0 / 30;
  const double t = seconds > 0 ? seconds : kFrame;
  return {limits.speed * t, limits.turn * t, limits.bend * t};
}

bool is_within(const Scene& scene, const Reach& reach, const Eigen::VectorXd& from,
               const Eigen::VectorXd& to) {
  constexpr double kRounding = 1e-9;
  const Eigen::VectorXd motion = difference(scene, from, to);
  return std::ranges::all_of(tangent_parts(scene), [&](const TangentPart& part) {
    if (part.size == 0) return true;
    const auto moved = motion.segment(part.first, part.size);
    switch (part.kind) {
      case ParameterKind::position:
        return moved.norm() <= std::sqrt(3.0) * reach.position + kRounding;
      case ParameterKind::quaternion:
        return moved.norm() <= std::sqrt(3.0) * reach.rotation + kRounding;
      case ParameterKind::angle:
        return moved.cwiseAbs().maxCoeff() <= reach.angle + kRounding;
      case ParameterKind::length:
        return moved.cwiseAbs().maxCoeff() <= reach.position + kRounding;
    }
    return true;
  });
}

}  // namespace hypotrack::internal
