#pragma once

#include <cmath>
#include <cstdint>

#include "hypotrack/gpu/skeleton.hpp"

/// Solids that approximate parts of models, and the penetration depth of two of them. Metres,
/// single precision; the same source for the CPU and the GPU.
namespace hypotrack::interpenetration {

/// A capsule or a box, in the frame of a bone. A capsule has all points within `radius` of the
/// segment centre +- half. A box has half its edges in `half`, along the bone's axes.
struct Shape {
  std::int32_t bone;  ///< index among the scene's bones
  std::int32_t is_box;
  float center[3];
  float half[3];
  float radius;  ///< 0 for a box
};

/// A shape in the world.
struct PosedShape {
  float center[3];
  float half[3];  ///< of a capsule: rotated to the world; of a box: along its axes
  float reach;    ///< radius of a sphere about the centre that contains it
  float radius;
  const float* axes;  ///< of a box: world_from_bone, 3x4 row by row
};

HYPOTRACK_PIXEL float dot(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

HYPOTRACK_PIXEL float clamp(float value, float lowest, float highest) {
  return pixel::min(pixel::max(value, lowest), highest);
}

HYPOTRACK_PIXEL PosedShape posed(const Shape& shape, const Placement& world_from_bone) {
  const float* m = world_from_bone.m;
  PosedShape out;
  for (int r = 0; r < 3; ++r) {
    out.center[r] = dot(m + 4 * r, shape.center) + m[4 * r + 3];
    out.half[r] = shape.is_box ? shape.half[r] : dot(m + 4 * r, shape.half);
  }
  out.reach = std::sqrt(dot(shape.half, shape.half)) + shape.radius;
  out.radius = shape.radius;
  out.axes = m;
  return out;
}

/// Returns whether the bounding spheres overlap by more than `slack`.
HYPOTRACK_PIXEL bool may_collide(const PosedShape& a, const PosedShape& b, float slack) {
  const float d[3] = {a.center[0] - b.center[0], a.center[1] - b.center[1],
                      a.center[2] - b.center[2]};
  const float reach = a.reach + b.reach - slack;
  return reach > 0 && dot(d, d) < reach * reach;  // false with NaN
}

/// Returns the penetration depth of two capsules: the sum of the radii minus the distance of the
/// segments (C. Ericson, Real-Time Collision Detection, 5.1.9). Negative if they are apart.
HYPOTRACK_PIXEL float capsules_depth(const PosedShape& p, const PosedShape& q) {
  const float r[3] = {p.center[0] - q.center[0], p.center[1] - q.center[1],
                      p.center[2] - q.center[2]};
  const float *u = p.half, *v = q.half;
  constexpr float kPoint = 1e-12f;  // square of a length
  const float a = dot(u, u), e = dot(v, v), b = dot(u, v), c = dot(u, r), f = dot(v, r);
  float s = 0, t = 0;  // the nearest points are centre + s * u and centre + t * v
  if (a > kPoint && e > kPoint) {
    const float parallel = a * e - b * b;
    if (parallel > 1e-6f * a * e) s = clamp((b * f - c * e) / parallel, -1.0f, 1.0f);
    t = clamp((b * s + f) / e, -1.0f, 1.0f);
    s = clamp((b * t - c) / a, -1.0f, 1.0f);
  } else if (a > kPoint) {
    s = clamp(-c / a, -1.0f, 1.0f);
  } else if (e > kPoint) {
    t = clamp(f / e, -1.0f, 1.0f);
  }
  float d[3];
  for (int i = 0; i < 3; ++i) d[i] = r[i] + s * u[i] - t * v[i];
  return p.radius + q.radius - std::sqrt(dot(d, d));
}

/// Returns the signed distance of a point (in the box's frame) from the box's surface, negative
/// inside.
HYPOTRACK_PIXEL float box_distance(const float* point, const float* half) {
  float outside = 0, inside = -half[0] - half[1] - half[2];
  for (int i = 0; i < 3; ++i) {
    const float q = std::fabs(point[i]) - half[i];
    const float positive = pixel::max(q, 0.0f);
    outside += positive * positive;
    inside = pixel::max(inside, q);
  }
  return std::sqrt(outside) + pixel::min(inside, 0.0f);
}

/// Transforms a vector of the world to a box's axes.
HYPOTRACK_PIXEL void to_box(const PosedShape& box, const float* world, float* out) {
  for (int i = 0; i < 3; ++i) {
    out[i] = box.axes[i] * world[0] + box.axes[4 + i] * world[1] + box.axes[8 + i] * world[2];
  }
}

/// Returns the penetration depth of a capsule in a box: its radius minus the least signed distance
/// of its segment from the surface. That distance is convex along the segment, so a golden-section
/// search finds the minimum.
HYPOTRACK_PIXEL float capsule_box_depth(const PosedShape& capsule, const PosedShape& box) {
  const float d[3] = {capsule.center[0] - box.center[0], capsule.center[1] - box.center[1],
                      capsule.center[2] - box.center[2]};
  float center[3], along[3];
  to_box(box, d, center);
  to_box(box, capsule.half, along);
  const auto at = [&](float t) {
    const float point[3] = {center[0] + t * along[0], center[1] + t * along[1],
                            center[2] + t * along[2]};
    return box_distance(point, box.half);
  };
  constexpr int kSections = 18;  // 2 * 0.618^18: within 0.02 % of the segment
  constexpr float kGolden = 0.618034f;
  float low = -1, high = 1;
  float a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  float at_a = at(a), at_b = at(b);
  for (int i = 0; i < kSections; ++i) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = at(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = at(b);
    }
  }
  return capsule.radius - pixel::min(at_a, at_b);
}

/// Returns the penetration depth of two boxes along the best separating axis, among face normals
/// and cross products of edges. Negative if they are apart, by no more than their distance.
HYPOTRACK_PIXEL float boxes_depth(const PosedShape& p, const PosedShape& q) {
  const float d[3] = {q.center[0] - p.center[0], q.center[1] - p.center[1],
                      q.center[2] - p.center[2]};
  float t[3], turn[3][3];  // q's centre and axes (columns) in the frame of p
  to_box(p, d, t);
  for (int k = 0; k < 3; ++k) {
    const float axis[3] = {q.axes[k], q.axes[4 + k], q.axes[8 + k]};
    float in_p[3];
    to_box(p, axis, in_p);
    for (int i = 0; i < 3; ++i) turn[i][k] = in_p[i];
  }
  float gap = -1e30f;
  for (int i = 0; i < 3; ++i) {  // faces
    const float extent_q = q.half[0] * std::fabs(turn[i][0]) + q.half[1] * std::fabs(turn[i][1]) +
                           q.half[2] * std::fabs(turn[i][2]);
    gap = pixel::max(gap, std::fabs(t[i]) - p.half[i] - extent_q);
    const float along = t[0] * turn[0][i] + t[1] * turn[1][i] + t[2] * turn[2][i];
    const float extent_p = p.half[0] * std::fabs(turn[0][i]) + p.half[1] * std::fabs(turn[1][i]) +
                           p.half[2] * std::fabs(turn[2][i]);
    gap = pixel::max(gap, std::fabs(along) - q.half[i] - extent_p);
  }
  for (int i = 0; i < 3; ++i) {  // pairs of edges
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int k = 0; k < 3; ++k) {
      const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      const float length = std::sqrt(pixel::max(1 - turn[i][k] * turn[i][k], 0.0f));
      if (length < 1e-3f) continue;  // parallel: the faces cover it
      const float extents =
          p.half[i1] * std::fabs(turn[i2][k]) + p.half[i2] * std::fabs(turn[i1][k]) +
          q.half[k1] * std::fabs(turn[i][k2]) + q.half[k2] * std::fabs(turn[i][k1]);
      const float along = std::fabs(t[i2] * turn[i1][k] - t[i1] * turn[i2][k]);
      gap = pixel::max(gap, (along - extents) / length);
    }
  }
  return -gap;
}

}  // namespace hypotrack::interpenetration
