#include "camera/pair_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace hypotrack {
namespace {

/// Cosine of the angle between optical axes up to which a pair has a left and a right camera.
constexpr double kSameWay = 0.94;  // 20 degrees

bool same_picture(const cv::Mat& a, const cv::Mat& b) {
  return !a.empty() && a.size() == b.size() && a.type() == b.type() &&
         cv::norm(a, b, cv::NORM_INF) == 0;
}

}  // namespace

std::string problem_of_pair(std::span<const Camera> cameras, const Frame& frame) {
  if (cameras.size() != 2 || frame.views.size() != 2) return {};
  if (same_picture(frame.views[0].color, frame.views[1].color))
    return fmt::format(
        "both views of frame {} show the same picture, and nothing can be told from that about "
        "depth; is the second view read from files of its own (source)?",
        frame.index);
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

}  // namespace hypotrack
