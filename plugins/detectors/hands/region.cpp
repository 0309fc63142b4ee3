#include "region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace hypotrack::hands {
namespace {

// MediaPipe's numbers: how far regions reach up from the palm's box, or the joints', and how much
// larger they are.
constexpr double kPalmShift = 0.5, kPalmScale = 2.6;
constexpr double kJointShift = 0.1, kJointScale = 2.0;

/// Returns the angle of a hand whose wrist and middle knuckle are apart by `up`.
double angle_of(const Eigen::Vector2d& up) {
  return std::numbers::pi / 2 - std::atan2(-up.y(), up.x());
}

}  // namespace

Region region_of(const Palm& palm) {
  Region out;
  out.angle = angle_of(palm.points.col(kPalmMiddle) - palm.points.col(kPalmWrist));
  const Eigen::Vector2d size = palm.box.sizes();
  const Eigen::Vector2d shift(0, -kPalmShift * size.y());
  out.center = palm.box.center() + rotation_of(out) * shift;
  out.side = kPalmScale * size.maxCoeff();
  return out;
}

Region region_of(const HandPoints& p) {
  // Fingers bend: only what lies below their middle joints.
  constexpr std::array<int, 12> kSteady = {0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
  Region out;
  out.angle = angle_of(((p.col(5) + p.col(13)) / 2 + p.col(9)) / 2 - p.col(0));
  const Eigen::Matrix2d rotation = rotation_of(out);
  Eigen::AlignedBox2d box;
  for (const int i : kSteady) box.extend(Eigen::Vector2d(rotation.transpose() * p.col(i)));
  const Eigen::Vector2d size = box.sizes();
  const Eigen::Vector2d shift(0, -kJointShift * size.y());
  out.center = rotation * (box.center() + shift);
  out.side = kJointScale * size.maxCoeff();
  return out;
}

bool nearly_equal(const Region& a, const Region& b) {
  constexpr double kShare = 0.05;  // of the side, and radians
  return (a.center - b.center).norm() < kShare * a.side &&
         std::abs(a.side - b.side) < kShare * a.side &&
         std::abs(std::remainder(a.angle - b.angle, 2 * std::numbers::pi)) < kShare;
}

Eigen::Matrix2d rotation_of(const Region& region) {
  const double c = std::cos(region.angle), s = std::sin(region.angle);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

cv::Mat cut_out(const cv::Mat& picture, const Region& region, int side) {
  const Eigen::Matrix2d a = rotation_of(region) * (region.side / side);
  const Eigen::Vector2d middle = Eigen::Vector2d::Constant((side - 1) / 2.0);
  const Eigen::Vector2d b = region.center - a * middle;
  const cv::Matx23d picture_from_cut(a(0, 0), a(0, 1), b.x(), a(1, 0), a(1, 1), b.y());
  cv::Mat out;
  cv::warpAffine(picture, out, picture_from_cut, {side, side},
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  return out;
}

}  // namespace hypotrack::hands
