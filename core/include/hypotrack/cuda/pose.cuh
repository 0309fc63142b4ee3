#pragma once

#include "hypotrack/cuda/block.cuh"
#include "hypotrack/cuda/layout.hpp"

/// From search points to bone matrices: what SearchSpace::states, Scene::normalize and BonePoser do
/// on the CPU.
namespace hypotrack::cuda {

/// Models with larger parameters, or NaN, are not drawn.
inline constexpr double kLargestParameter = 1e6;

struct Quaternion {
  double w, x, y, z;
};

__device__ inline Quaternion multiply(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z, a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x};
}

__device__ inline Quaternion rotation_exp(double x, double y, double z) {
  const double angle = sqrt(x * x + y * y + z * z);
  if (angle < 1e-12) return {1.0, x / 2, y / 2, z / 2};
  const double factor = sin(angle / 2) / angle;
  return {cos(angle / 2), x * factor, y * factor, z * factor};
}

__device__ inline Quaternion normalized(Quaternion q) {
  const double scale = fmax(fmax(fabs(q.w), fabs(q.x)), fmax(fabs(q.y), fabs(q.z)));
  if (scale == 0.0) return {1.0, 0.0, 0.0, 0.0};
  q = {q.w / scale, q.x / scale, q.y / scale, q.z / scale};
  const double norm = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / norm, q.x / norm, q.y / norm, q.z / norm};
}

/// Where a model's parameters begin in a search point.
__device__ inline int point_offset(const ModelLayout& model, int index, bool rotation_vectors) {
  return model.offset - (rotation_vectors ? index : 0);
}

/// The model's unit quaternion in a search point.
__device__ inline Quaternion decode_rotation(const double* point, const double* prior, int offset) {
  if (!prior) return normalized({point[3], point[4], point[5], point[6]});
  const double* q = prior + offset + 3;
  return normalized(multiply({q[0], q[1], q[2], q[3]}, rotation_exp(point[3], point[4], point[5])));
}

/// Writes the model's part of the state and first_from_model (3x4).
__device__ inline void decode_pose(const ModelLayout& model, int index, const FrameLayout& frame,
                                   const BatchLayout& batch, const double* point, float* state,
                                   float* first_from_model) {
  const double* p = point + point_offset(model, index, batch.prior != nullptr);
  const Quaternion q = decode_rotation(p, batch.prior, model.offset);
  for (int i = 0; i < 3; ++i) state[model.offset + i] = static_cast<float>(p[i]);
  state[model.offset + 3] = static_cast<float>(q.w);
  state[model.offset + 4] = static_cast<float>(q.x);
  state[model.offset + 5] = static_cast<float>(q.y);
  state[model.offset + 6] = static_cast<float>(q.z);
  const double r[3][3] = {
      {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y)},
      {2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x)},
      {2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)}};
  const bool drawable = fabs(p[0]) <= kLargestParameter && fabs(p[1]) <= kLargestParameter &&
                        fabs(p[2]) <= kLargestParameter;
  for (int i = 0; i < 3; ++i) {
    const double* f = frame.first_from_world + 4 * i;
    for (int j = 0; j < 3; ++j) {
      first_from_model[4 * i + j] =
          static_cast<float>(f[0] * r[0][j] + f[1] * r[1][j] + f[2] * r[2][j]);
    }
    const double t = f[0] * p[0] + f[1] * p[1] + f[2] * p[2] + f[3];
    first_from_model[4 * i + 3] = drawable ? static_cast<float>(t) : nanf("");
  }
}

/// out = a * b for 3x4 matrices; `out` may be `b`.
__device__ inline void compose(const float* a, const float* b, float* out) {
  float result[12];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) {
      float sum = j == 3 ? a[4 * i + 3] : 0.0f;
      for (int k = 0; k < 3; ++k) sum += a[4 * i + k] * b[4 * k + j];
      result[4 * i + j] = sum;
    }
  }
  for (int i = 0; i < 12; ++i) out[i] = result[i];
}

/// Turns the frame of a 3x4 matrix about a unit axis.
__device__ inline void turn(float* m, const float* axis, float angle) {
  float s, c;
  sincosf(angle, &s, &c);
  const float x = axis[0], y = axis[1], z = axis[2], t = 1.0f - c;
  const float r[3][3] = {{t * x * x + c, t * x * y - s * z, t * x * z + s * y},
                         {t * x * y + s * z, t * y * y + c, t * y * z - s * x},
                         {t * x * z - s * y, t * y * z + s * x, t * z * z + c}};
  for (int i = 0; i < 3; ++i) {
    const float a = m[4 * i], b = m[4 * i + 1], d = m[4 * i + 2];
    for (int j = 0; j < 3; ++j) m[4 * i + j] = a * r[0][j] + b * r[1][j] + d * r[2][j];
  }
}

/// The bone's transform to its parent with all its turns.
__device__ inline void local_transform(const SceneLayout& scene, const BoneLayout& bone,
                                       const float* state, float* parent_from_bone) {
  for (int i = 0; i < 12; ++i) parent_from_bone[i] = bone.parent_from_bone[i];
  for (int k = 0; k < bone.turn_count; ++k) {
    const Turn& t = scene.turns[bone.first_turn + k];
    const float value = state[t.parameter];
    const float angle = fabsf(value) <= static_cast<float>(kLargestParameter)
                            ? t.scale * (value - t.zero)
                            : nanf("");
    turn(parent_from_bone, t.axis, angle);
  }
}

/// Decodes one hypothesis with one warp: `state` gets the scene's state, `first_from_models` a
/// matrix per model, NaN for one that cannot be drawn.
__device__ inline void decode(const SceneLayout& scene, const FrameLayout& frame,
                              const BatchLayout& batch, const double* point, float* state,
                              float* first_from_models) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  const int skipped = batch.prior ? 1 : 0;  // numbers that a rotation vector is shorter
  for (int m = 0; m < scene.model_count; ++m) {
    const ModelLayout model = scene.models[m];
    const double* p = point + point_offset(model, m, batch.prior != nullptr);
    for (int i = 7 + lane; i < model.dimension; i += kWarp) {
      state[model.offset + i] = static_cast<float>(p[i - skipped]);
    }
  }
  for (int m = lane; m < scene.model_count; m += kWarp) {
    decode_pose(scene.models[m], m, frame, batch, point, state, first_from_models + 12 * m);
  }
  __syncwarp();
}

/// Poses a decoded hypothesis with one warp: `bones` gets one matrix per bone that takes vertices
/// of the bind pose to the frame of the first view's camera.
__device__ inline void pose_bones(const SceneLayout& scene, const float* state,
                                  const float* first_from_models, float* bones) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp;
  for (int b = lane; b < scene.bone_count; b += kWarp) {
    local_transform(scene, scene.bones[b], state, bones + 12 * b);
  }
  for (int level = 0; level < scene.level_count; ++level) {
    __syncwarp();
    for (int b = lane; b < scene.bone_count; b += kWarp) {
      const BoneLayout& bone = scene.bones[b];
      if (bone.level != level) continue;
      const float* parent =
          bone.parent < 0 ? first_from_models + 12 * bone.model : bones + 12 * bone.parent;
      compose(parent, bones + 12 * b, bones + 12 * b);
    }
  }
  __syncwarp();
  for (int b = lane; b < scene.bone_count; b += kWarp) {
    compose(bones + 12 * b, scene.bones[b].bone_from_model, bones + 12 * b);
  }
}

}  // namespace hypotrack::cuda
