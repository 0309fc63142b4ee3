#include "euler_angles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hypotrack::bvh {
namespace {

/// Adds the whole turns to each angle that bring it nearest to the previous one.
Eigen::Vector3d unwrapped(Eigen::Vector3d angles, const Eigen::Vector3d& previous) {
  constexpr double kTurn = 2 * std::numbers::pi;
  for (int i = 0; i < 3; ++i) angles[i] += kTurn * std::round((previous[i] - angles[i]) / kTurn);
  return angles;
}

}  // namespace

Eigen::Vector3d zxy_angles(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& previous) {
  constexpr double kLocked = 1e-9;  // cosine of x; below it only the sum of z and y is known
  const double x = std::asin(std::clamp(rotation(2, 1), -1.0, 1.0));
  if (std::hypot(rotation(0, 1), rotation(1, 1)) < kLocked) {
    const double sign = x > 0 ? 1 : -1;
    const double sum = std::atan2(rotation(1, 0), rotation(0, 0));  // z + sign * y
    return unwrapped({sum - sign * previous.z(), x, previous.z()}, previous);
  }
  const Eigen::Vector3d one(std::atan2(-rotation(0, 1), rotation(1, 1)), x,
                            std::atan2(-rotation(2, 0), rotation(2, 2)));
  const double half_turn = std::numbers::pi;
  const Eigen::Vector3d a = unwrapped(one, previous);
  const Eigen::Vector3d b =
      unwrapped({one[0] + half_turn, half_turn - one[1], one[2] + half_turn}, previous);
  return (a - previous).squaredNorm() <= (b - previous).squaredNorm() ? a : b;
}

}  // namespace hypotrack::bvh
