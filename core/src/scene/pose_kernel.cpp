// Compiled once per instruction set: an include below includes this file again.
#include "scene/simd_kernels.hpp"

#define HWY_TARGET_INCLUDE "scene/pose_kernel.cpp"
#include <algorithm>
#include <cstring>
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "hypotrack/gpu/sine_cosine.hpp"

#ifndef HYPOTRACK_POSE_KERNEL_TYPES_
#define HYPOTRACK_POSE_KERNEL_TYPES_
namespace hypotrack::pose_kernel {

struct Row {
  float x, y, z, w;
};

struct SineCosine {
  float sine, cosine;
};

}  // namespace hypotrack::pose_kernel
#endif

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using pose_kernel::Row;
using pose_kernel::SineCosine;

// Returns a * b + c, in one rounding if the instruction set has that.
HWY_INLINE float fma(float a, float b, float c) {
  const hn::CappedTag<float, 1> one;
  return hn::GetLane(hn::MulAdd(hn::Set(one, a), hn::Set(one, b), hn::Set(one, c)));
}

// Computes sine and cosine; see hypotrack/gpu/sine_cosine.hpp.
HWY_INLINE SineCosine sine_and_cosine(float angle) {
  using namespace hypotrack::sine_cosine;
  const float biased = angle * kQuartersPerRadian + kRoundingBias;
  const float n = biased - kRoundingBias;
  const float r = fma(-n, kQuarterLow, fma(-n, kQuarterHigh, angle)), z = r * r;
  const float s = fma(fma(fma(fma(kS9, z, kS7), z, kS5), z, kS3), z * r, r);
  const float c = fma(fma(fma(fma(kC8, z, kC6), z, kC4), z, kC2), z, 1.0f);
  std::int32_t bits;
  std::memcpy(&bits, &biased, sizeof bits);
  const bool odd = (bits & 1) != 0;
  const float sine = odd ? c : s, cosine = odd ? s : c;
  return {(bits & 2) != 0 ? -sine : sine, ((bits + 1) & 2) != 0 ? -cosine : cosine};
}

HWY_INLINE float along(const Row& row, float x, float y, float z) {
  return fma(row.x, x, fma(row.y, y, row.z * z));
}

// Returns the inverse norm of a quaternion that is normalised up to rounding.
HWY_INLINE float inverse_norm(const float* q) {
  const float excess = fma(q[0], q[0], fma(q[1], q[1], fma(q[2], q[2], q[3] * q[3]))) - 1.0f;
  return fma(excess, fma(excess, 0.375f, -0.5f), 1.0f);
}

// Computes a row of first_from_model.
HWY_INLINE Row model_row(const float* state, const float* f) {
  const float scale = inverse_norm(state + 3);
  const float w = state[3] * scale, x = state[4] * scale;
  const float y = state[5] * scale, z = state[6] * scale;
  const auto dot = [&](float a, float b, float c, float d)
                       HWY_ATTR { return fma(f[0], a, fma(f[1], b, fma(f[2], c, d))); };
  const auto same = [](float u, float v) HWY_ATTR { return fma(-2.0f, fma(u, u, v * v), 1.0f); };
  const auto sum = [](float u, float v, float s, float t)
                       HWY_ATTR { return 2.0f * fma(u, v, s * t); };
  return {dot(same(y, z), sum(x, y, w, z), sum(x, z, -w, y), 0.0f),
          dot(sum(x, y, -w, z), same(x, z), sum(y, z, w, x), 0.0f),
          dot(sum(x, z, w, y), sum(y, z, -w, x), same(x, y), 0.0f),
          dot(state[0], state[1], state[2], f[3])};
}

// Computes a row of a transform whose frame is rotated about a unit axis.
HWY_INLINE Row turned(const Row& row, const cuda::JointMotion& t, const SineCosine& angle) {
  const float s = angle.sine, c = angle.cosine;
  const float x = t.axis[0], y = t.axis[1], z = t.axis[2], d = 1.0f - c;
  const float dx = d * x, dy = d * y, dz = d * z;
  return {along(row, fma(dx, x, c), fma(dx, y, s * z), fma(dx, z, -s * y)),
          along(row, fma(dx, y, -s * z), fma(dy, y, c), fma(dy, z, s * x)),
          along(row, fma(dx, z, s * y), fma(dy, z, -s * x), fma(dz, z, c)), row.w};
}

// Computes a row of a transform whose frame is moved along a unit axis.
HWY_INLINE Row slid(const Row& row, const cuda::JointMotion& t, float length) {
  const float x = length * t.axis[0], y = length * t.axis[1], z = length * t.axis[2];
  return {row.x, row.y, row.z, fma(row.x, x, fma(row.y, y, fma(row.z, z, row.w)))};
}

// Computes parent_from_bone with all motions of the bone.
HWY_INLINE void place(const SkeletonLayout& skeleton, const cuda::BoneLayout& bone,
                      const float* state, Row* rows) {
  for (int r = 0; r < 3; ++r) {
    const float* bind = bone.parent_from_bone + 4 * r;
    rows[r] = {bind[0], bind[1], bind[2], bind[3]};
  }
  for (int k = 0; k < bone.motion_count; ++k) {
    const cuda::JointMotion& t = skeleton.motions[bone.first_motion + k];
    const float amount = t.scale * (state[t.parameter] - t.zero);
    if (t.slides) {
      for (int r = 0; r < 3; ++r) rows[r] = slid(rows[r], t, amount);
      continue;
    }
    const SineCosine angle = sine_and_cosine(amount);
    for (int r = 0; r < 3; ++r) rows[r] = turned(rows[r], t, angle);
  }
}

// Multiplies m with the columns of `to`; the last column is a point, the others are vectors.
HWY_INLINE void transform(const Row* m, float* to) {
  for (int column = 0; column < 4; ++column) {
    const float w = column == 3 ? 1.0f : 0.0f;
    const float x = to[column], y = to[4 + column], z = to[8 + column];
    for (int r = 0; r < 3; ++r) {
      to[4 * r + column] = fma(m[r].x, x, fma(m[r].y, y, fma(m[r].z, z, m[r].w * w)));
    }
  }
}

void pose(const SkeletonLayout& skeleton, const float* state, const float* first_from_world,
          float* locals, float* first_from_bind) {
  auto* rows = reinterpret_cast<Row*>(locals);
  Row model[3];
  for (int r = 0; r < 3; ++r) model[r] = model_row(state, first_from_world + 4 * r);
  for (int b = 0; b < skeleton.bone_count; ++b) {
    place(skeleton, skeleton.bones[b], state, rows + 3 * b);
  }
  for (int b = 0; b < skeleton.bone_count; ++b) {
    float* out = first_from_bind + 12 * b;
    std::copy_n(skeleton.bones[b].bone_from_model, 12, out);
    for (int at = b; at >= 0; at = skeleton.bones[at].parent) transform(rows + 3 * at, out);
    transform(model, out);
  }
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {
HWY_EXPORT(pose);
}  // namespace

void pose_skeleton(const SkeletonLayout& skeleton, const float* state,
                   const float* first_from_world, float* locals, float* first_from_bind) {
  HWY_DYNAMIC_DISPATCH(pose)(skeleton, state, first_from_world, locals, first_from_bind);
}

}  // namespace hypotrack::internal
#endif
