#include "region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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

/// Returns where the tiles of a row or column begin, at equal steps of half a side at most.
std::vector<int> starts(int length, int side) {
  if (length <= side) return {0};
  const int count = 1 + (2 * (length - side) + side - 1) / side;
  std::vector<int> out;
  for (int i = 0; i < count; ++i) out.push_back((length - side) * i / (count - 1));
  return out;
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

bool nearly_equal(const Region& a, const Region& b, double share) {
  return (a.center - b.center).norm() < share * a.side &&
         std::abs(a.side - b.side) < share * a.side &&
         std::abs(std::remainder(a.angle - b.angle, 2 * std::numbers::pi)) < share;
}

Eigen::Matrix2d rotation_of(const Region& region) {
  const double c = std::cos(region.angle), s = std::sin(region.angle);
  return (Eigen::Matrix2d() << c, -s, s, c).finished();
}

std::vector<int> tile_sides(const cv::Size& picture, double smallest_hand) {
  if (smallest_hand <= 0) return {};
  constexpr double kSideOfHand = 6.4;  // the palm detector finds hands of a share of the picture
  constexpr double kApart = 2.5;       // sides: tiles find hands up to half their side
  constexpr int kSmallest = 64;
  const double first = std::max(picture.width, picture.height);
  const double last = std::max(smallest_hand * kSideOfHand, double{kSmallest});
  if (first <= last) return {};
  const auto count = static_cast<int>(std::ceil(std::log(first / last) / std::log(kApart)));
  std::vector<int> out;
  for (int i = 1; i <= count; ++i)
    out.push_back(static_cast<int>(std::lround(first * std::pow(last / first, double(i) / count))));
  return out;
}

std::vector<cv::Rect> tiles(const cv::Size& picture, int side) {
  std::vector<cv::Rect> out;
  for (const int y : starts(picture.height, side)) {
    for (const int x : starts(picture.width, side)) {
      out.emplace_back(x, y, std::min(side, picture.width - x), std::min(side, picture.height - y));
    }
  }
  return out;
}

}  // namespace hypotrack::hands
