#pragma once

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/layout.hpp"

/// From search points to bone matrices: what SearchSpace::states, Scene::normalize and BonePoser do
/// on the CPU.
namespace hypotrack::cuda {

/// Models with larger parameters, or NaN, are not drawn.
inline constexpr double kLargestParameter = 1e6;

struct Quaternion {
  float w, x, y, z;
};

__device__ inline Quaternion multiply(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z, a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x};
}

__device__ inline Quaternion rotation_exp(float x, float y, float z) {
  const float angle = sqrtf(x * x + y * y + z * z);
  if (angle < 1e-6f) return {1.0f, x / 2, y / 2, z / 2};
  float s, c;
  sincosf(angle / 2, &s, &c);
  const float factor = s / angle;
  return {c, x * factor, y * factor, z * factor};
}

/// Four numbers of any size as a unit quaternion; zeros are the identity.
__device__ inline Quaternion unit_quaternion(const double* wxyz) {
  const double scale = fmax(fmax(fabs(wxyz[0]), fabs(wxyz[1])), fmax(fabs(wxyz[2]), fabs(wxyz[3])));
  if (scale == 0.0) return {1.0f, 0.0f, 0.0f, 0.0f};
  const double factor = scale > 1e-3 && scale < 1e3 ? 1.0 : 1.0 / scale;  // squares fit a float
  const auto w = static_cast<float>(wxyz[0] * factor), x = static_cast<float>(wxyz[1] * factor);
  const auto y = static_cast<float>(wxyz[2] * factor), z = static_cast<float>(wxyz[3] * factor);
  const float inverse = 1.0f / sqrtf(w * w + x * x + y * y + z * z);
  return {w * inverse, x * inverse, y * inverse, z * inverse};
}

/// Where a model's parameters begin in a search point.
__device__ inline int point_offset(const ModelLayout& model, int index, bool rotation_vectors) {
  return model.offset - (rotation_vectors ? index : 0);
}

/// The unit quaternion of a model whose parameters in the search point are `p`.
__device__ inline Quaternion decode_rotation(const double* p, const double* prior, int offset) {
  if (!prior) return unit_quaternion(p + 3);
  const Quaternion turn =
      rotation_exp(static_cast<float>(p[3]), static_cast<float>(p[4]), static_cast<float>(p[5]));
  return multiply(unit_quaternion(prior + offset + 3), turn);
}

/// Writes the pose in the model's part of the state and first_from_model (3x4), NaN unless
/// `drawable`.
__device__ inline void decode_pose(const ModelLayout& model, const FrameLayout& frame,
                                   const double* p, const double* prior, bool drawable,
                                   float* state, float* first_from_model) {
  const Quaternion q = decode_rotation(p, prior, model.offset);
  for (int i = 0; i < 3; ++i) state[model.offset + i] = static_cast<float>(p[i]);
  state[model.offset + 3] = q.w;
  state[model.offset + 4] = q.x;
  state[model.offset + 5] = q.y;
  state[model.offset + 6] = q.z;
  const float r[3][3] = {
      {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y)},
      {2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x)},
      {2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)}};
  for (int i = 0; i < 3; ++i) {
    const double* f = frame.first_from_world + 4 * i;
    for (int j = 0; j < 3; ++j) {
      first_from_model[4 * i + j] = static_cast<float>(f[0]) * r[0][j] +
                                    static_cast<float>(f[1]) * r[1][j] +
                                    static_cast<float>(f[2]) * r[2][j];
    }
    // The world's origin may be far away: double precision until the difference is taken.
    const double t = f[0] * p[0] + f[1] * p[1] + f[2] * p[2] + f[3];
    first_from_model[4 * i + 3] = drawable ? static_cast<float>(t) : nanf("");
  }
}

/// A row of a 3x4 matrix times one, `columns`, in memory.
__device__ __forceinline__ float4 multiply(const float4& row, const float* columns) {
  const auto* m = reinterpret_cast<const float4*>(columns);
  const float4 a = m[0], b = m[1], c = m[2];
  return {fmaf(row.x, a.x, fmaf(row.y, b.x, row.z * c.x)),
          fmaf(row.x, a.y, fmaf(row.y, b.y, row.z * c.y)),
          fmaf(row.x, a.z, fmaf(row.y, b.z, row.z * c.z)),
          fmaf(row.x, a.w, fmaf(row.y, b.w, fmaf(row.z, c.w, row.w)))};
}

/// A row of a transform whose frame is turned about a unit axis.
__device__ __forceinline__ float4 turned(const float4& row, float x, float y, float z,
                                         float angle) {
  float s, c;
  if (fabsf(angle) < 3.2f) {
    __sincosf(angle, &s, &c);  // within 4e-7 here
  } else {
    sincosf(angle, &s, &c);
  }
  const float t = 1.0f - c;
  const float a = row.x, b = row.y, d = row.z;
  return {a * (t * x * x + c) + b * (t * x * y + s * z) + d * (t * x * z - s * y),
          a * (t * x * y - s * z) + b * (t * y * y + c) + d * (t * y * z + s * x),
          a * (t * x * z + s * y) + b * (t * y * z - s * x) + d * (t * z * z + c), row.w};
}

/// Decodes one hypothesis with one warp: `state` gets the scene's state, `first_from_models` a
/// matrix per model, NaN for one with a parameter beyond kLargestParameter.
__device__ __noinline__ inline void decode(const ModelLayout* models, int model_count,
                                           const FrameLayout& frame, const double* prior,
                                           const double* point, float* state,
                                           float* first_from_models) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int pose_size = prior ? 6 : 7;
  for (int base = 0; base < model_count; base += kWarp) {
    const int end = min(base + kWarp, model_count);
    bool own_drawable = false;
    for (int m = base; m < end; ++m) {
      const ModelLayout model = models[m];
      const double* p = point + point_offset(model, m, prior != nullptr);
      const int size = model.dimension - 7 + pose_size;
      bool drawable = true;
      for (int i = lane; i < size; i += kWarp) {
        drawable = drawable && fabs(p[i]) <= kLargestParameter;  // NaN: false
        if (i >= pose_size) state[model.offset + 7 - pose_size + i] = static_cast<float>(p[i]);
      }
      drawable = __all_sync(kWholeWarp, drawable);
      if (lane == m - base) own_drawable = drawable;
    }
    if (const int m = base + lane; m < end) {
      const ModelLayout model = models[m];
      const double* p = point + point_offset(model, m, prior != nullptr);
      decode_pose(model, frame, p, prior, own_drawable, state, first_from_models + 12 * m);
    }
  }
}

/// Poses a decoded hypothesis with the whole block, a thread per row of a bone's matrix: `bones`
/// gets one matrix per bone that takes vertices of the bind pose to the frame of the first view's
/// camera. Ends with a barrier. `layouts` and `turns` are the scene's, wherever they lie.
__device__ __noinline__ inline void pose_bones(const SceneLayout& scene, const BoneLayout* layouts,
                                               const Turn* turns, const float* state,
                                               const float* first_from_models, float* bones) {
  const int first = static_cast<int>(threadIdx.x), step = static_cast<int>(blockDim.x);
  const int rows = 3 * scene.bone_count;
  auto* out = reinterpret_cast<float4*>(bones);
  for (int i = first; i < rows; i += step) {  // parent_from_bone
    const BoneLayout& bone = layouts[i / 3];
    const float* bind = bone.parent_from_bone + 4 * (i % 3);
    float4 row = {bind[0], bind[1], bind[2], bind[3]};
    for (int k = 0; k < bone.turn_count; ++k) {
      const Turn& t = turns[bone.first_turn + k];
      row = turned(row, t.axis[0], t.axis[1], t.axis[2], t.scale * (state[t.parameter] - t.zero));
    }
    out[i] = row;
  }
  for (int level = 0; level < scene.level_count; ++level) {
    __syncthreads();
    for (int i = first; i < (rows + step - 1) / step * step; i += step) {
      const bool mine = i < rows && layouts[i / 3].level == level;
      float4 row;
      if (mine) {
        const BoneLayout& bone = layouts[i / 3];
        const float* parent =
            bone.parent < 0 ? first_from_models + 12 * bone.model : bones + 12 * bone.parent;
        row = multiply(reinterpret_cast<const float4*>(parent)[i % 3], bones + 12 * (i / 3));
      }
      __syncthreads();  // all rows of a matrix are read before any is overwritten
      if (mine) out[i] = row;
    }
  }
  __syncthreads();
  for (int i = first; i < rows; i += step) {
    float bind[12];
    for (int k = 0; k < 12; ++k) bind[k] = layouts[i / 3].bone_from_model[k];
    const float4 r = out[i];
    out[i] = {r.x * bind[0] + r.y * bind[4] + r.z * bind[8],
              r.x * bind[1] + r.y * bind[5] + r.z * bind[9],
              r.x * bind[2] + r.y * bind[6] + r.z * bind[10],
              r.x * bind[3] + r.y * bind[7] + r.z * bind[11] + r.w};
  }
  __syncthreads();
}

}  // namespace hypotrack::cuda
