#include "skin_lines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "field.hpp"
#include "noise.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double bell(double x, double half_width) { return std::exp2(-x * x / (half_width * half_width)); }

/// Points of a Catmull-Rom spline through the given ones.
std::vector<Vector2d> smooth_curve(const std::vector<Vector2d>& knots) {
  constexpr int kSteps = 8;
  std::vector<Vector2d> curve;
  const int n = static_cast<int>(knots.size());
  for (int i = 0; i + 1 < n; ++i) {
    const Vector2d &p = knots[std::max(i - 1, 0)], &q = knots[i], &r = knots[i + 1],
                   &s = knots[std::min(i + 2, n - 1)];
    for (int k = 0; k < kSteps; ++k) {
      const double t = static_cast<double>(k) / kSteps;
      curve.push_back(0.5 * (2 * q + t * (r - p) + t * t * (2 * p - 5 * q + 4 * r - s) +
                             t * t * t * (3 * q - p - 3 * r + s)));
    }
  }
  curve.push_back(knots.back());
  return curve;
}

}  // namespace

SkinCurve::SkinCurve(std::vector<Vector2d> points, double width, double strength)
    : points_(smooth_curve(points)), width_(width), strength_(strength) {
  for (const Vector2d& p : points_) box_.extend(p);
  box_ = Eigen::AlignedBox2d(box_.min().array() - 4 * width, box_.max().array() + 4 * width);
}

double SkinCurve::operator()(const Vector2d& p) const {
  if (!box_.contains(p)) return 0;
  double least = 1e9, place = 0;
  for (size_t i = 0; i + 1 < points_.size(); ++i) {
    const Vector2d edge = points_[i + 1] - points_[i];
    const double t = std::clamp(edge.dot(p - points_[i]) / edge.squaredNorm(), 0.0, 1.0);
    const double distance = (points_[i] + t * edge - p).squaredNorm();
    if (distance < least) {
      least = distance;
      place = (i + t) / (points_.size() - 1);
    }
  }
  const double fade = smooth_step(0, 0.12, place) * (1 - smooth_step(0.8, 1, place));
  return strength_ * bell(std::sqrt(least), width_) * (0.35 + 0.65 * fade);
}

std::vector<SkinCurve> palm_lines() {
  std::vector<SkinCurve> lines;
  // The creases of the thumb, of the index and middle, and of the three ulnar fingers.
  lines.push_back({{{33, 74}, {24, 72}, {14, 63}, {7, 49}, {4.5, 33}, {7, 15}}, 0.55, 1.0});
  lines.push_back({{{33, 76}, {20, 74}, {4, 66}, {-10, 58}, {-24, 52}, {-32, 47}}, 0.5, 0.9});
  lines.push_back({{{-45, 67}, {-34, 70}, {-20, 76}, {-6, 82}, {5, 89}, {11, 97}}, 0.55, 0.95});
  lines.push_back({{{-1, 20}, {-3, 36}, {-2, 54}, {-5, 76}}, 0.35, 0.4});
  lines.push_back({{{-22, 30}, {-17, 46}, {-16, 60}, {-20, 72}}, 0.3, 0.3});
  // Wrist.
  lines.push_back({{{34, 3}, {15, 1}, {-5, 0}, {-34, 4}}, 0.5, 0.75});
  lines.push_back({{{34, -3}, {12, -4.5}, {-8, -5}, {-34, -2}}, 0.4, 0.45});
  // Fine ones, scattered, mostly along the hand or across the thenar.
  for (int i = 0; i < 46; ++i) {
    const auto random = [i](int k) { return hash_unit(i, k, 0, 77); };
    const Vector2d at(-40 + 75 * random(0), 12 + 88 * random(1));
    const double angle = (at.x() > 8 && at.y() < 70 ? 2.2 : 1.4) + 1.3 * (random(2) - 0.5);
    const double half = 3 + 8 * random(3), bend = 2.0 * (random(4) - 0.5);
    const Vector2d along(std::cos(angle), std::sin(angle)), side(-along.y(), along.x());
    lines.push_back({{at - half * along, at + bend * side, at + half * along},
                     0.2 + 0.12 * random(5),
                     0.18 + 0.28 * random(6)});
  }
  return lines;
}

std::vector<SkinCurve> dorsal_veins() {
  return {
      {{{20, -14}, {17, 18}, {12, 40}, {15, 62}, {15, 84}, {14, 104}}, 1.5, 1.0},
      {{{12, 40}, {2, 52}, {-5, 70}, {-6, 88}, {-8, 106}}, 1.3, 0.9},
      {{{-18, -14}, {-15, 12}, {-18, 36}, {-27, 58}, {-26, 76}, {-30, 96}}, 1.4, 0.9},
      {{{-18, 36}, {-8, 46}, {2, 52}}, 1.1, 0.7},
      {{{-5, 70}, {-14, 64}, {-24, 50}}, 1.0, 0.6},
      {{{15, 62}, {24, 55}, {34, 44}, {42, 46}}, 1.1, 0.6},
      {{{-27, 58}, {-36, 66}, {-42, 80}}, 0.9, 0.5},
      {{{4, -14}, {2, 10}, {-5, 28}, {-18, 36}}, 1.0, 0.5},
  };
}

JointCreases::JointCreases(const std::vector<SkeletonBone>& skeleton) {
  using Places = std::vector<Vector3d>;
  const Places knuckle_folds{{-5.2, 0.3, 0.35}, {-3.4, 0.35, 0.6}, {-1.8, 0.4, 0.85},
                             {-0.2, 0.4, 0.9},  {1.4, 0.4, 0.8},   {2.9, 0.35, 0.6},
                             {4.6, 0.3, 0.35}};
  const Places small_folds{{-1.9, 0.28, 0.45}, {-0.7, 0.3, 0.6}, {0.6, 0.3, 0.6}, {1.9, 0.28, 0.4}};
  const Places at_base{{15.5, 0.5, 0.85}, {18.0, 0.35, 0.55}, {12.0, 0.25, 0.25}};
  const Places at_pip{{-1.3, 0.45, 0.95}, {1.4, 0.42, 0.85}, {-4.2, 0.25, 0.3}, {4.5, 0.25, 0.3}};
  const Places at_dip{{0.0, 0.45, 0.95}, {1.9, 0.28, 0.4}, {-2.6, 0.22, 0.25}};
  const Places thumb_base{{2.0, 0.45, 0.7}, {6.5, 0.4, 0.55}, {-3.0, 0.3, 0.35}};
  for (int d = 0; d < kDigits; ++d)
    for (int k = d == kThumb ? 2 : 1; k < kBonesPerDigit; ++k) {
      const int bone = bone_index(d, k);
      Eigen::Isometry3d joint = skeleton[bone].hand_from_bone;
      if (k > 1)
        joint.linear() =
            Eigen::Quaterniond(joint.linear())
                .slerp(0.5, Eigen::Quaterniond(skeleton[bone - 1].hand_from_bone.linear()))
                .matrix();
      Joint j{joint.inverse(), 0.72 * digit_measures()[d].pip_breadth, k == 1 ? 0.4 : 1.0, {}, {}};
      if (k == 3) j.palmar = at_dip, j.dorsal = d == kThumb ? knuckle_folds : small_folds;
      if (k == 2) j.palmar = d == kThumb ? thumb_base : at_pip, j.dorsal = knuckle_folds;
      if (k == 1) j.palmar = at_base, j.dorsal = small_folds;
      joints_.push_back(std::move(j));
    }
}

double JointCreases::operator()(const Vector3d& p, double palmar) const {
  double strongest = 0;
  for (const Joint& joint : joints_) {
    const Vector3d local = joint.joint_from_hand * p;
    const double away = std::hypot(local.x(), local.z());
    if (std::abs(local.y()) > 22 || away > joint.radius + 4) continue;
    const double near = 1 - smooth_step(joint.radius, joint.radius + 4, away);
    const double x = local.x() / joint.radius;
    const double waver = 0.6 * noise(p / 2.6, 31) + 0.25 * noise(p / 0.9, 32);
    const double palmar_side = smooth_step(0.3, 0.75, palmar);
    for (const Vector3d& fold : joint.palmar) {
      const double gap = 0.65 + 0.5 * noise(p / 3.1 + fold, 34);
      strongest = std::max(strongest, near * palmar_side * fold[2] * gap *
                                          bell(local.y() - fold[0] - 0.8 * x * x - waver, fold[1]));
    }
    // Folds over a knuckle close around it like eyelids.
    const double dorsal_side = joint.dorsal_share * (1 - smooth_step(0.15, 0.6, palmar));
    for (const Vector3d& fold : joint.dorsal) {
      const double gap = 0.7 + 0.6 * noise(p / 1.7 + fold, 33);
      const double bow = fold[0] * (1 - 1.1 * x * x);
      strongest = std::max(
          strongest, near * dorsal_side * fold[2] * gap * bell(local.y() - bow - waver, fold[1]));
    }
  }
  return strongest;
}

double JointCreases::knuckle(const Vector3d& p) const {
  double most = 0;
  for (const Joint& joint : joints_) {
    const Vector3d local = joint.joint_from_hand * p;
    most =
        std::max(most, bell(local.y(), 6.0) *
                           (1 - smooth_step(0.7 * joint.radius, joint.radius + 5, local.norm())) *
                           smooth_step(0, 5, -local.z()));
  }
  return most;
}

}  // namespace hypotrack::hand_mesh
