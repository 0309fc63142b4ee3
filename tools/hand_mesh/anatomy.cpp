#include "anatomy.hpp"

#include <numbers>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double deg(double degrees) { return degrees * std::numbers::pi / 180.0; }

Matrix3d flex(double angle) { return AngleAxisd(angle, Vector3d::UnitX()).matrix(); }

Matrix3d abduct(double angle) { return AngleAxisd(angle, -Vector3d::UnitZ()).matrix(); }

Matrix3d twist(double angle) { return AngleAxisd(angle, Vector3d::UnitY()).matrix(); }

Isometry3d frame(const Vector3d& origin, const Matrix3d& rotation) {
  Isometry3d f = Isometry3d::Identity();
  f.linear() = rotation;
  f.translation() = origin;
  return f;
}

/// Rotation whose y is `direction` and whose z is as palmar as that allows.
Matrix3d frame_along(const Vector3d& direction) {
  const Vector3d y = direction.normalized();
  const Vector3d x = y.cross(Vector3d::UnitZ()).normalized();
  Matrix3d r;
  r << x, y, x.cross(y);
  return r;
}

/// Rotation of a digit's first moving bone.
Matrix3d first_rotation(int digit, double abduction, double flexion) {
  const Matrix3d moved = abduct(abduction) * twist(digit_measures()[digit].twist) * flex(flexion);
  return digit == kThumb ? Matrix3d(abduct(deg(45)) * twist(deg(-60)) * moved) : moved;
}

/// Where the first moving bone begins and how long the three are.
Vector3d moving_base(int digit) {
  const DigitMeasures& m = digit_measures()[digit];
  if (digit == kThumb) return m.base;
  return m.base + m.metacarpal * m.metacarpal_direction.normalized();
}

std::array<double, 3> moving_lengths(int digit) {
  const DigitMeasures& m = digit_measures()[digit];
  if (digit == kThumb) return {m.metacarpal, m.proximal, m.distal + m.tip};
  return {m.proximal, m.middle, m.distal + m.tip};
}

}  // namespace

const std::array<DigitMeasures, kDigits>& digit_measures() {
  // The bind pose is half way between a flat hand and a fist, and the fingers are apart: linear
  // blend skinning then has to turn no joint by more than about 80 degrees.
  static const std::array<DigitMeasures, kDigits> measures{{
      {"thumb",
       46.2,
       31.6,
       0,
       21.7,
       5.7,
       22.0,
       21.5,
       {17.5, 21, 8},
       {0, 0, 0},
       deg(0),
       deg(15),
       {deg(12), deg(10), deg(15)}},
      {"index",
       68.1,
       39.8,
       22.4,
       15.8,
       3.8,
       19.6,
       17.2,
       {10, 30, 1},
       {16.5, 66.0, -1.0},
       deg(-3),
       deg(7),
       {deg(14), deg(24), deg(13)}},
      {"middle",
       64.6,
       44.6,
       26.3,
       17.4,
       4.0,
       19.9,
       17.4,
       {2, 32, -1},
       {2.0, 64.6, -1.0},
       deg(0),
       deg(0),
       {deg(13), deg(24), deg(13)}},
      {"ring",
       58.0,
       41.4,
       25.7,
       17.3,
       4.0,
       18.6,
       16.3,
       {-6, 31.5, 0},
       {-11.0, 57.0, 0.0},
       deg(4),
       deg(-7),
       {deg(14), deg(25), deg(13)}},
      {"little",
       53.7,
       32.7,
       18.1,
       16.0,
       3.7,
       16.6,
       14.6,
       {-14.5, 28.5, 2},
       {-21.5, 49.2, 1.5},
       deg(8),
       deg(-16),
       {deg(15), deg(24), deg(13)}},
  }};
  return measures;
}

std::vector<Isometry3d> pose_skeleton(const std::array<std::array<double, 4>, kDigits>& angles) {
  std::vector<Isometry3d> bones{Isometry3d::Identity()};
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitMeasures& m = digit_measures()[digit];
    const Vector3d base = moving_base(digit);
    const Vector3d fixed = digit == kThumb ? Vector3d(9, 8, 4) : m.base;
    bones.push_back(frame(fixed, frame_along(base - fixed) * twist(m.twist)));
    const auto& [abduction, first, second, third] = angles[digit];
    Isometry3d bone = frame(base, first_rotation(digit, abduction, first));
    bones.push_back(bone);
    const std::array<double, 3> lengths = moving_lengths(digit);
    for (int k = 0; k < 2; ++k) {
      bone = bone * frame({0, lengths[k], 0}, flex(k == 0 ? second : third));
      bones.push_back(bone);
    }
  }
  return bones;
}

std::vector<SkeletonBone> bind_skeleton() {
  std::array<std::array<double, 4>, kDigits> angles{};
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitMeasures& m = digit_measures()[digit];
    angles[digit] = {m.abduction, m.flexion[0], m.flexion[1], m.flexion[2]};
  }
  const std::vector<Isometry3d> frames = pose_skeleton(angles);
  std::vector<SkeletonBone> bones{{"wrist", -1, kHandLength, frames[0]}};
  for (int digit = 0; digit < kDigits; ++digit) {
    const std::array<double, 3> lengths = moving_lengths(digit);
    for (int k = 0; k < kBonesPerDigit; ++k) {
      const int i = bone_index(digit, k);
      const double length =
          k > 0 ? lengths[k - 1] : (moving_base(digit) - frames[i].translation()).norm();
      bones.push_back({digit_measures()[digit].name + ("_" + std::to_string(k)), k == 0 ? 0 : i - 1,
                       length, frames[i]});
    }
  }
  return bones;
}

}  // namespace hypotrack::hand_mesh
