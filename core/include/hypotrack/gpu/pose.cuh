#pragma once

#include "hypotrack/gpu/block.cuh"
#include "hypotrack/gpu/block_plan.hpp"
#include "hypotrack/gpu/layout.hpp"
#include "hypotrack/gpu/sine_cosine.hpp"

/// Decodes search points to bone matrices. The first step equals SearchSpace::states and
/// Scene::normalize on the CPU. The next uses the operations of core/src/scene/pose_kernel.cpp,
/// so that normalised states give equal matrices.
namespace hypotrack::cuda {

/// Largest magnitude of a parameter. A model with a larger one, or NaN, is not drawn.
inline constexpr double kLargestParameter = 1e6;

template <class T>
__device__ __forceinline__ const T& shared_item(int offset, int index) {
  return reinterpret_cast<const T*>(shared_floats() + offset)[index];
}

template <class Real>
struct Quaternion {
  Real w, x, y, z;
};

template <class Real>
__device__ __forceinline__ Quaternion<Real> multiply(const Quaternion<Real>& a,
                                                     const Quaternion<Real>& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z, a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x};
}

/// Returns the unit quaternion of a rotation vector.
template <class Real>
__device__ __forceinline__ Quaternion<Real> rotation_exp(Real x, Real y, Real z) {
  const Real angle = sqrt(x * x + y * y + z * z);
  if (angle < Real(1e-6)) return {Real(1), x / 2, y / 2, z / 2};
  const Real factor = sin(angle / 2) / angle;
  return {cos(angle / 2), x * factor, y * factor, z * factor};
}

/// Returns 1 / norm of four numbers whose squares are in range.
__device__ __forceinline__ double inverse_norm(double w, double x, double y, double z) {
  return rsqrt(w * w + x * x + y * y + z * z);
}
__device__ __forceinline__ float inverse_norm(float w, float x, float y, float z) {
  const float square = fmaf(w, w, fmaf(x, x, fmaf(y, y, z * z))), excess = square - 1.0f;
  // As on the CPU, whose states are always normalised up to rounding.
  if (fabsf(excess) < 1e-3f) return fmaf(excess, fmaf(excess, 0.375f, -0.5f), 1.0f);
  return rsqrtf(square);
}

/// Returns four numbers as a unit quaternion; zeros give the identity.
template <class Real>
__device__ __forceinline__ Quaternion<Real> unit_quaternion(Real w, Real x, Real y, Real z) {
  const Real scale = fmax(fmax(fabs(w), fabs(x)), fmax(fabs(y), fabs(z)));
  if (scale == Real(0)) return {Real(1), Real(0), Real(0), Real(0)};
  if (!(scale > Real(1e-3) && scale < Real(1e3))) {  // the squares' sum might leave the range
    w /= scale, x /= scale, y /= scale, z /= scale;
  }
  const Real inverse = inverse_norm(w, x, y, z);
  return {w * inverse, x * inverse, y * inverse, z * inverse};
}

/// Returns the unit quaternion of a model whose parameters in the search point start at `p`.
template <class Real>
__device__ __forceinline__ Quaternion<Real> decode_rotation(const Real* p, const double* prior,
                                                            int offset) {
  if (!prior) return unit_quaternion(p[3], p[4], p[5], p[6]);
  const double* q = prior + offset + 3;
  const auto start =
      unit_quaternion(static_cast<Real>(__ldcg(q)), static_cast<Real>(__ldcg(q + 1)),
                      static_cast<Real>(__ldcg(q + 2)), static_cast<Real>(__ldcg(q + 3)));
  return multiply(start, rotation_exp(p[3], p[4], p[5]));
}

/// Writes a number of a search point, or NaN if it cannot be drawn; a barrier must follow.
__device__ __forceinline__ void put_in_point(int index, double number, const PoseMemory& at) {
  shared_floats()[at.point + index] =
      fabs(number) <= kLargestParameter ? static_cast<float>(number) : nanf("");
}

/// Reads a search point with the whole block; a barrier must follow.
__device__ __forceinline__ void load_point(const double* point, int size, const PoseMemory& at) {
  for (int i = static_cast<int>(threadIdx.x); i < size; i += static_cast<int>(blockDim.x)) {
    put_in_point(i, __ldcg(point + i), at);
  }
}

/// Returns the index of a model's first parameter in a search point.
__device__ __forceinline__ int first_in_point(const ModelLayout& model, int index, bool shorter) {
  return model.offset - (shorter ? index : 0);
}

/// Copies a model's parameters after its pose to the state, with one warp. Marks a model that
/// cannot be drawn.
__device__ __forceinline__ void copy_angles(const ModelLayout& model, int index,
                                            const double* prior, const PoseMemory& at) {
  const int pose = prior ? 6 : 7, lane = static_cast<int>(threadIdx.x) % kWarp;
  const float* p = shared_floats() + at.point + first_in_point(model, index, prior != nullptr);
  float* state = shared_floats() + at.state + model.offset + 7 - pose;
  bool drawable = true;
  for (int i = lane; i < model.dimension - 7 + pose; i += kWarp) {
    const float value = p[i];
    drawable = drawable && value == value;
    if (i >= pose) state[i] = value;
  }
  drawable = __all_sync(kWholeWarp, drawable);
  if (lane == 0) shared_floats()[at.drawable + index] = drawable ? 0.0f : nanf("");
}

/// Computes a row of first_from_model; row 0 also writes the pose to the state.
__device__ __forceinline__ void decode_row(const ModelLayout& model, int index, int row,
                                           const FrameLayout& frame, const double* prior,
                                           const PoseMemory& at) {
  const float* p = shared_floats() + at.point + first_in_point(model, index, prior != nullptr);
  const Quaternion<float> q = decode_rotation(p, prior, model.offset);
  const float* f = frame.first_from_world + 4 * row;
  const float a = f[0], b = f[1], c = f[2];
  float4& out = reinterpret_cast<float4*>(shared_floats() + at.models)[3 * index + row];
  const auto along = [&](float x, float y, float z, float w) {
    return fmaf(a, x, fmaf(b, y, fmaf(c, z, w)));
  };
  const auto same = [](float u, float v) { return fmaf(-2.0f, fmaf(u, u, v * v), 1.0f); };
  const auto sum = [](float u, float v, float s, float t) { return 2.0f * fmaf(u, v, s * t); };
  out = {along(same(q.y, q.z), sum(q.x, q.y, q.w, q.z), sum(q.x, q.z, -q.w, q.y), 0.0f),
         along(sum(q.x, q.y, -q.w, q.z), same(q.x, q.z), sum(q.y, q.z, q.w, q.x), 0.0f),
         along(sum(q.x, q.z, q.w, q.y), sum(q.y, q.z, -q.w, q.x), same(q.x, q.y), 0.0f),
         along(p[0], p[1], p[2], f[3])};
  if (row > 0) return;
  float* state = shared_floats() + at.state + model.offset;
  for (int i = 0; i < 3; ++i) state[i] = p[i];
  state[3] = q.w;
  state[4] = q.x;
  state[5] = q.y;
  state[6] = q.z;
}

/// Computes the sine and cosine of an angle as in hypotrack/gpu/sine_cosine.hpp.
__device__ __forceinline__ void sine_and_cosine(float angle, float& sine, float& cosine) {
  using namespace hypotrack::sine_cosine;
  const float biased = angle * kQuartersPerRadian + kRoundingBias;
  const float n = biased - kRoundingBias;
  const float r = fmaf(-n, kQuarterLow, fmaf(-n, kQuarterHigh, angle)), z = r * r;
  const float s = fmaf(fmaf(fmaf(fmaf(kS9, z, kS7), z, kS5), z, kS3), z * r, r);
  const float c = fmaf(fmaf(fmaf(fmaf(kC8, z, kC6), z, kC4), z, kC2), z, 1.0f);
  const int bits = __float_as_int(biased);
  const bool odd = (bits & 1) != 0;
  sine = odd ? c : s;
  cosine = odd ? s : c;
  if ((bits & 2) != 0) sine = -sine;
  if (((bits + 1) & 2) != 0) cosine = -cosine;
}

/// Rotates the frame of a transform about a unit axis; computes one row.
__device__ __forceinline__ float4 turned(const float4& row, const JointMotion& t, float angle) {
  float s, c;
  sine_and_cosine(angle, s, c);
  const float x = t.axis[0], y = t.axis[1], z = t.axis[2], d = 1.0f - c;
  const float dx = d * x, dy = d * y, dz = d * z;
  const auto along = [&](float a, float b, float g) {
    return fmaf(row.x, a, fmaf(row.y, b, row.z * g));
  };
  return {along(fmaf(dx, x, c), fmaf(dx, y, s * z), fmaf(dx, z, -s * y)),
          along(fmaf(dx, y, -s * z), fmaf(dy, y, c), fmaf(dy, z, s * x)),
          along(fmaf(dx, z, s * y), fmaf(dy, z, -s * x), fmaf(dz, z, c)), row.w};
}

/// Moves the frame of a transform along a unit axis; computes one row.
__device__ __forceinline__ float4 slid(const float4& row, const JointMotion& t, float length) {
  const float x = length * t.axis[0], y = length * t.axis[1], z = length * t.axis[2];
  return {row.x, row.y, row.z, fmaf(row.x, x, fmaf(row.y, y, fmaf(row.z, z, row.w)))};
}

/// Computes a row of parent_from_bone with all motions of the bone. Joints have the same values in
/// a search point as in the state, at other indices.
__device__ __forceinline__ void place_row(int bone, int row, const double* prior,
                                          const PoseMemory& at) {
  const BoneLayout& layout = shared_item<BoneLayout>(at.bone_layouts, bone);
  const float* bind = layout.parent_from_bone + 4 * row;
  const int shift = prior ? layout.model + 1 : 0;
  float4 out = {bind[0], bind[1], bind[2], bind[3]};
  for (int k = 0; k < layout.motion_count; ++k) {
    const JointMotion& t = shared_item<JointMotion>(at.motions, layout.first_motion + k);
    const float amount = t.scale * (shared_floats()[at.point + t.parameter - shift] - t.zero);
    out = t.slides ? slid(out, t, amount) : turned(out, t, amount);
  }
  reinterpret_cast<float4*>(shared_floats() + at.locals)[3 * bone + row] = out;
}

/// Returns m * (x, y, z, w) for a 3x4 matrix in shared memory.
__device__ __forceinline__ float3 transform(int matrix, const float3& v, float w) {
  const auto* rows = reinterpret_cast<const float4*>(shared_floats() + matrix);
  const float4 a = rows[0], b = rows[1], c = rows[2];
  return {fmaf(a.x, v.x, fmaf(a.y, v.y, fmaf(a.z, v.z, a.w * w))),
          fmaf(b.x, v.x, fmaf(b.y, v.y, fmaf(b.z, v.z, b.w * w))),
          fmaf(c.x, v.x, fmaf(c.y, v.y, fmaf(c.z, v.z, c.w * w)))};
}

/// Computes a column of a bone's matrix: from the bind pose through the chain of bones to the
/// camera.
__device__ __forceinline__ void chain_column(int bone, int column, const PoseMemory& at) {
  const BoneLayout& layout = shared_item<BoneLayout>(at.bone_layouts, bone);
  const float* bind = layout.bone_from_model + column;
  const float w = column == 3 ? 1.0f : 0.0f;
  const float drawable = shared_floats()[at.drawable + layout.model];  // 0 or NaN
  float3 v = {bind[0] + drawable, bind[4], bind[8]};
  for (int b = bone; b >= 0; b = shared_item<BoneLayout>(at.bone_layouts, b).parent) {
    v = transform(at.locals + 12 * b, v, w);
  }
  v = transform(at.models + 12 * layout.model, v, w);
  float* out = shared_floats() + at.bones + 12 * bone + column;
  out[0] = v.x;
  out[4] = v.y;
  out[8] = v.z;
}

/// Decodes a loaded point with the whole block into state, model poses and drawable flags; a
/// barrier must follow.
__device__ __forceinline__ void decode(const SceneLayout& scene, const FrameLayout& frame,
                                       const double* prior, const PoseMemory& at) {
  // Use the last warps, because the first ones are busy with bones.
  const int warps = static_cast<int>(blockDim.x) / kWarp;
  const int warp = warps - 1 - static_cast<int>(threadIdx.x) / kWarp;
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  for (int m = warp; m < 2 * scene.model_count; m += warps) {
    const ModelLayout& model = shared_item<ModelLayout>(at.model_layouts, m / 2);
    if (m % 2 == 0) {
      copy_angles(model, m / 2, prior, at);
    } else if (lane < 3) {
      decode_row(model, m / 2, lane, frame, prior, at);
    }
  }
}

/// Poses the hypothesis of a loaded search point with the whole block; ends with a barrier.
__device__ __forceinline__ void pose(const SceneLayout& scene, const FrameLayout& frame,
                                     const double* prior, const PoseMemory& at) {
  const int thread = static_cast<int>(threadIdx.x), threads = static_cast<int>(blockDim.x);
  decode(scene, frame, prior, at);
  for (int i = thread; i < 3 * scene.bone_count; i += threads) place_row(i / 3, i % 3, prior, at);
  __syncthreads();
  for (int i = thread; i < 4 * scene.bone_count; i += threads) chain_column(i / 4, i % 4, at);
  __syncthreads();
}

}  // namespace hypotrack::cuda
