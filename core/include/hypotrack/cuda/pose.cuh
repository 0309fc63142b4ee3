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

/// A 3x4 matrix in registers.
struct Transform {
  float m[12];
};

/// 16-byte aligned memory to registers and back.
__device__ __forceinline__ Transform load_transform(const float* from) {
  Transform t;
#pragma unroll
  for (int i = 0; i < 3; ++i) {
    const float4 row = reinterpret_cast<const float4*>(from)[i];
    t.m[4 * i] = row.x;
    t.m[4 * i + 1] = row.y;
    t.m[4 * i + 2] = row.z;
    t.m[4 * i + 3] = row.w;
  }
  return t;
}
__device__ __forceinline__ void store_transform(const Transform& t, float* to) {
#pragma unroll
  for (int i = 0; i < 3; ++i) {
    reinterpret_cast<float4*>(to)[i] = {t.m[4 * i], t.m[4 * i + 1], t.m[4 * i + 2], t.m[4 * i + 3]};
  }
}

__device__ __forceinline__ Transform operator*(const Transform& a, const Transform& b) {
  Transform out;
#pragma unroll
  for (int i = 0; i < 3; ++i) {
#pragma unroll
    for (int j = 0; j < 4; ++j) {
      out.m[4 * i + j] =
          fmaf(a.m[4 * i], b.m[j],
               fmaf(a.m[4 * i + 1], b.m[4 + j],
                    fmaf(a.m[4 * i + 2], b.m[8 + j], j == 3 ? a.m[4 * i + 3] : 0.0f)));
    }
  }
  return out;
}

/// Turns the frame of a transform about a unit axis.
__device__ __forceinline__ void turn(Transform& transform, float x, float y, float z, float angle) {
  float s, c;
  sincosf(angle, &s, &c);
  const float t = 1.0f - c;
  const float r[3][3] = {{t * x * x + c, t * x * y - s * z, t * x * z + s * y},
                         {t * x * y + s * z, t * y * y + c, t * y * z - s * x},
                         {t * x * z - s * y, t * y * z + s * x, t * z * z + c}};
#pragma unroll
  for (int i = 0; i < 3; ++i) {
    float* row = transform.m + 4 * i;
    const float a = row[0], b = row[1], d = row[2];
#pragma unroll
    for (int j = 0; j < 3; ++j) row[j] = a * r[0][j] + b * r[1][j] + d * r[2][j];
  }
}

/// The bone's transform to its parent with all its turns.
__device__ inline Transform local_transform(const BoneLayout& bone, const Turn* turns,
                                            const float* state) {
  Transform parent_from_bone;
#pragma unroll
  for (int i = 0; i < 12; ++i) parent_from_bone.m[i] = bone.parent_from_bone[i];
  for (int k = 0; k < bone.turn_count; ++k) {
    const Turn t = turns[bone.first_turn + k];
    turn(parent_from_bone, t.axis[0], t.axis[1], t.axis[2],
         t.scale * (state[t.parameter] - t.zero));
  }
  return parent_from_bone;
}

/// Decodes one hypothesis with one warp: `state` gets the scene's state, `first_from_models` a
/// matrix per model, NaN for one with a parameter beyond kLargestParameter.
__device__ __noinline__ inline void decode(const SceneLayout& scene, const FrameLayout& frame,
                                           const BatchLayout& batch, const double* point,
                                           float* state, float* first_from_models) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int pose_size = batch.prior ? 6 : 7;
  for (int base = 0; base < scene.model_count; base += kWarp) {
    const int end = min(base + kWarp, scene.model_count);
    bool own_drawable = false;
    for (int m = base; m < end; ++m) {
      const ModelLayout model = scene.models[m];
      const double* p = point + point_offset(model, m, batch.prior != nullptr);
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
      const ModelLayout model = scene.models[m];
      const double* p = point + point_offset(model, m, batch.prior != nullptr);
      decode_pose(model, frame, p, batch.prior, own_drawable, state, first_from_models + 12 * m);
    }
  }
  __syncwarp();
}

/// Poses a decoded hypothesis with one warp: `bones` gets one matrix per bone that takes vertices
/// of the bind pose to the frame of the first view's camera. `layouts` and `turns` are the scene's,
/// wherever they lie.
__device__ __noinline__ inline void pose_bones(const SceneLayout& scene, const BoneLayout* layouts,
                                               const Turn* turns, const float* state,
                                               const float* first_from_models, float* bones) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  for (int b = lane; b < scene.bone_count; b += kWarp) {
    store_transform(local_transform(layouts[b], turns, state), bones + 12 * b);
  }
  for (int level = 0; level < scene.level_count; ++level) {
    __syncwarp();
    for (int b = lane; b < scene.bone_count; b += kWarp) {
      const BoneLayout& bone = layouts[b];
      if (bone.level != level) continue;
      const float* parent =
          bone.parent < 0 ? first_from_models + 12 * bone.model : bones + 12 * bone.parent;
      store_transform(load_transform(parent) * load_transform(bones + 12 * b), bones + 12 * b);
    }
  }
  __syncwarp();
  for (int b = lane; b < scene.bone_count; b += kWarp) {
    Transform bone_from_model;
#pragma unroll
    for (int i = 0; i < 12; ++i) bone_from_model.m[i] = layouts[b].bone_from_model[i];
    store_transform(load_transform(bones + 12 * b) * bone_from_model, bones + 12 * b);
  }
}

}  // namespace hypotrack::cuda
