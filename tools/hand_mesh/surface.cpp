#include "surface.hpp"

#include <algorithm>

namespace hypotrack::hand_mesh {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

/// Frame at `from` whose y points to `to` and whose z is as palmar as that allows.
Isometry3d frame_between(const Vector3d& from, const Vector3d& to) {
  const Vector3d y = (to - from).normalized();
  const Vector3d x = y.cross(Vector3d::UnitZ()).normalized();
  Isometry3d frame = Isometry3d::Identity();
  frame.linear() << x, y, x.cross(y);
  frame.translation() = from;
  return frame;
}

}  // namespace

HandSurface::HandSurface() : skeleton_(bind_skeleton()) {
  add_thumb();
  for (int d = 1; d < kDigits; ++d) add_finger(d);
  add_palm();
  add_webs();
}

/// The three phalanges of a finger; the tip tapers, is flat under the nail and full at the pulp.
void HandSurface::add_finger(int d) {
  const DigitMeasures& m = digit_measures()[d];
  const double w = 0.5 * m.pip_breadth, e = 0.5 * m.dip_breadth;
  const SkeletonBone* bone = &skeleton_[bone_index(d, 1)];
  digits_[d].emplace_back(bone[0].hand_from_bone, bone[0].length,
                          std::vector<ProfileKnot>{{0.0, 1.08 * w, 1.12 * w, 1.02 * w},
                                                   {0.3, 1.00 * w, 1.10 * w, 0.92 * w},
                                                   {0.68, 0.93 * w, 0.99 * w, 0.84 * w},
                                                   {1.0, 0.98 * w, 0.84 * w, 0.90 * w}},
                          0.9 * w, 0.85 * w, 2.15);
  digits_[d].emplace_back(bone[1].hand_from_bone, bone[1].length,
                          std::vector<ProfileKnot>{{0.0, 0.98 * w, 0.84 * w, 0.90 * w},
                                                   {0.45, 0.90 * w, 0.97 * w, 0.77 * w},
                                                   {1.0, 0.98 * e, 0.85 * e, 0.85 * e}},
                          0.85 * w, 0.8 * e, 2.15);
  const double tip = 1.25 * e;
  digits_[d].emplace_back(bone[2].hand_from_bone, bone[2].length - tip,
                          std::vector<ProfileKnot>{{0.0, 0.98 * e, 0.85 * e, 0.85 * e},
                                                   {0.55, 0.98 * e, 0.96 * e, 0.76 * e},
                                                   {1.0, 0.96 * e, 0.98 * e, 0.66 * e}},
                          0.8 * e, tip, 2.2);
}

/// The free part of the thumb; its metacarpal belongs to the palm.
void HandSurface::add_thumb() {
  const DigitMeasures& m = digit_measures()[kThumb];
  const double w = 0.5 * m.pip_breadth, e = 0.5 * m.dip_breadth;
  const SkeletonBone* bone = &skeleton_[bone_index(kThumb, 1)];
  digits_[kThumb].emplace_back(
      bone[0].hand_from_bone, bone[0].length,
      std::vector<ProfileKnot>{
          {0.0, 11.5, 12.0, 10.0}, {0.5, 10.8, 13.0, 9.4}, {1.0, w, 0.98 * w, 0.92 * w}},
      9.0, 0.9 * w);
  digits_[kThumb].emplace_back(bone[1].hand_from_bone, bone[1].length,
                               std::vector<ProfileKnot>{{0.0, w, 0.98 * w, 0.92 * w},
                                                        {0.5, 0.88 * w, 0.93 * w, 0.80 * w},
                                                        {1.0, 0.97 * e, 0.84 * e, 0.86 * e}},
                               0.9 * w, 0.85 * e, 2.15);
  const double tip = 1.3 * e;
  digits_[kThumb].emplace_back(bone[2].hand_from_bone, bone[2].length - tip,
                               std::vector<ProfileKnot>{{0.0, 0.97 * e, 0.84 * e, 0.86 * e},
                                                        {0.5, 1.02 * e, 0.94 * e, 0.76 * e},
                                                        {1.0, 1.04 * e, 0.96 * e, 0.60 * e}},
                               0.85 * e, tip, 2.2);
}

/// Metacarpals, wrist and the two eminences.
void HandSurface::add_palm() {
  static const double kHeadWidth[] = {0, 11.0, 11.4, 11.0, 9.6};
  for (int d = 1; d < kDigits; ++d) {
    const SkeletonBone& bone = skeleton_[bone_index(d, 0)];
    const double h = kHeadWidth[d];
    palm_.emplace_back(bone.hand_from_bone, bone.length,
                       std::vector<ProfileKnot>{{0.0, 11.0, 15.0, 13.5},
                                                {0.5, h, 12.5, 11.0},
                                                {0.85, h, 13.0, 10.0},
                                                {1.0, h, 13.5, 10.4}},
                       9.0, 13.0);
  }
  palm_.emplace_back(frame_between({0, -kStumpLength - 15, 2}, {1, 14, 1}), kStumpLength + 29,
                     std::vector<ProfileKnot>{
                         {0.0, 29.0, 19.5, 18.5}, {0.6, 28.5, 19.0, 18.0}, {1.0, 27.5, 17.5, 16.5}},
                     5.0, 26.0, 2.3);
  pads_.push_back(ellipsoid(
      frame_between({22, 36, 11}, skeleton_[bone_index(kThumb, 2)].hand_from_bone.translation()),
      {15.0, 27.0, 15.5}));
  pads_.push_back(ellipsoid(frame_between({-22, 36, 10}, {-33, 70, 12}), {13.0, 31.0, 13.5}));
  // The ulnar border, and the muscle between thumb and index on the back.
  pads_.push_back(ellipsoid(frame_between({-33.5, 59, 6}, {-40, 82, 7}), {8.5, 24.0, 10.5}));
  pads_.push_back(ellipsoid(frame_between({24.5, 58, 2}, {29, 80, 1}), {8.0, 24.0, 8.0}));
  // From the wrist into the thumb.
  pads_.push_back(ellipsoid(frame_between({22, 16, 5}, {32, 38, 10}), {9.5, 24.0, 12.0}));
}

/// Skin between neighbouring digits.
void HandSurface::add_webs() {
  const auto along = [&](int d, int k, double y, double z) -> Vector3d {
    return skeleton_[bone_index(d, k)].hand_from_bone * Vector3d(0, y, z);
  };
  for (int d = 1; d + 1 < kDigits; ++d)
    webs_.push_back({along(d, 1, 10.5, 2), along(d + 1, 1, d == 3 ? 14.0 : 11.5, 2),
                     0.5 * (along(d, 0, 60, 2) + along(d + 1, 0, 48, 2)), 7.0});
  webs_.push_back({along(kThumb, 1, 8, 0), along(kThumb, 1, 36, 1), along(1, 0, 58, 3), 7.5});
}

double HandSurface::palm(const Vector3d& p) const {
  double d = palm_.front()(p);
  for (size_t i = 1; i < palm_.size(); ++i) d = smooth_min(d, palm_[i](p), 7.0);
  for (const Limb& pad : pads_) d = smooth_min(d, pad(p), 8.0);
  for (const Web& web : webs_)
    d = smooth_min(d, rounded_triangle(p, web.a, web.b, web.c, web.radius), 6.0);
  return d;
}

double HandSurface::digit(int d, const Vector3d& p) const {
  double value = digits_[d].front()(p);
  for (size_t i = 1; i < digits_[d].size(); ++i) value = smooth_min(value, digits_[d][i](p), 1.5);
  return value;
}

double HandSurface::operator()(const Vector3d& p) const {
  const double base = palm(p);
  double skin = base;
  for (int d = 0; d < kDigits; ++d)
    skin = smooth_min(skin, smooth_min(base, digit(d, p), d == kThumb ? 12.0 : 7.0), 2.0);
  return smooth_max(skin, -kStumpLength - p.y(), 8.0);
}

Vector3d HandSurface::gradient(const Vector3d& p) const {
  constexpr double kStep = 0.02;
  Vector3d g;
  for (int i = 0; i < 3; ++i) {
    const Vector3d step = kStep * Vector3d::Unit(i);
    g[i] = ((*this)(p + step) - (*this)(p - step)) / (2 * kStep);
  }
  return g;
}

Vector3d HandSurface::project(Vector3d p) const {
  for (int i = 0; i < 6; ++i) {
    const double value = (*this)(p);
    if (std::abs(value) < 1e-4) break;
    const Vector3d g = gradient(p);
    p -= std::clamp(value / std::max(g.squaredNorm(), 0.2), -2.0, 2.0) * g;
  }
  return p;
}

}  // namespace hypotrack::hand_mesh
