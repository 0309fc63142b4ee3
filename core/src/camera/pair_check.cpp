#include "camera/pair_check.hpp"

#include <fmt/format.h>

#include <cmath>

namespace hypotrack::internal {
namespace {

/// Least cosine of the angle between optical axes of a pair with a left and a right camera.
constexpr double kSameWay = 0.94;  // 20 degrees

}  // namespace

std::string problem_of_pair(std::span<const Camera> cameras) {
  if (cameras.size() != 2) return {};
  const Eigen::Isometry3d first_from_second =
      cameras[0].camera_from_world * cameras[1].camera_from_world.inverse();
  const Eigen::Vector3d second = first_from_second.translation();
  const bool beside = std::abs(second.x()) > second.tail<2>().norm();
  if (!beside || second.x() > 0 || first_from_second.linear()(2, 2) < kSameWay) return {};
  return fmt::format(
      "the second camera stands {:.0f} mm to the left of the first; if it does not, the "
      "calibration "
      "has the cameras the wrong way round, or a T of the wrong sign",
      -1000 * second.x());
}

}  // namespace hypotrack::internal
