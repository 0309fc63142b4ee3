#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/gpu/layout.hpp"
#include "hypotrack/plugin/pixel.hpp"

/// Single-precision bone transforms for terms that read only the state. CPU and GPU compile this
/// source.
namespace hypotrack {

/// Pointers to a Skeleton in host or device memory.
struct SkeletonLayout {
  std::int32_t bone_count;
  std::int32_t levels;        ///< number of hierarchy levels: the deepest bone's + 1
  const std::int32_t* level;  ///< depth of every bone in the hierarchy; 0 for a root
  const cuda::ModelLayout* models;
  const cuda::BoneLayout* bones;
  const cuda::JointMotion* motions;
};

/// A team of one thread. The CPU passes it where cuda::StateObjective passes a warp.
struct OneThread {
  HYPOTRACK_PIXEL int rank() const { return 0; }
  HYPOTRACK_PIXEL int size() const { return 1; }
  HYPOTRACK_PIXEL void sync() const {}
  HYPOTRACK_PIXEL double sum(double value) const { return value; }
};

/// Discards the residuals of a term (cuda::StateObjective) when only its cost is wanted.
struct IgnoreResidual {
  HYPOTRACK_PIXEL void operator()(std::int64_t /*i*/, float /*residual*/) const {}
};

/// A rigid transform as a 3x4 matrix (rotation, translation), row by row.
struct Placement {
  float m[12];
};

/// Returns the product a * b.
HYPOTRACK_PIXEL Placement compose(const Placement& a, const float* b) {
  Placement out;
  for (int r = 0; r < 3; ++r) {
    const float* row = a.m + 4 * r;
    for (int c = 0; c < 4; ++c) {
      out.m[4 * r + c] = row[0] * b[c] + row[1] * b[4 + c] + row[2] * b[8 + c];
    }
    out.m[4 * r + 3] += row[3];
  }
  return out;
}

/// Rotates the frame of a placement about a unit axis (Rodrigues' formula).
HYPOTRACK_PIXEL void turn(Placement& placement, const float* axis, float angle) {
  const float s = std::sin(angle), c = std::cos(angle), d = 1.0f - c;
  const float x = axis[0], y = axis[1], z = axis[2];
  for (int r = 0; r < 3; ++r) {
    float* row = placement.m + 4 * r;
    const float a = row[0], b = row[1], e = row[2];
    row[0] = a * (d * x * x + c) + b * (d * x * y + s * z) + e * (d * x * z - s * y);
    row[1] = a * (d * x * y - s * z) + b * (d * y * y + c) + e * (d * y * z + s * x);
    row[2] = a * (d * x * z + s * y) + b * (d * y * z - s * x) + e * (d * z * z + c);
  }
}

/// Moves the frame of a placement along a unit axis.
HYPOTRACK_PIXEL void slide(Placement& placement, const float* axis, float length) {
  for (int r = 0; r < 3; ++r) {
    float* row = placement.m + 4 * r;
    row[3] += length * (row[0] * axis[0] + row[1] * axis[1] + row[2] * axis[2]);
  }
}

/// Returns world_from_model of a normalised pose: position x y z, then quaternion w x y z.
HYPOTRACK_PIXEL Placement place_model(const double* pose) {
  const auto w = static_cast<float>(pose[3]), x = static_cast<float>(pose[4]);
  const auto y = static_cast<float>(pose[5]), z = static_cast<float>(pose[6]);
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
           static_cast<float>(pose[0]), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
           2 * (y * z - w * x), static_cast<float>(pose[1]), 2 * (x * z - w * y),
           2 * (y * z + w * x), 1 - 2 * (x * x + y * y), static_cast<float>(pose[2])}};
}

/// Returns parent_from_bone of a bone, with the motions of the state applied.
HYPOTRACK_PIXEL Placement place_bone(const SkeletonLayout& skeleton, int bone,
                                     const double* state) {
  const cuda::BoneLayout& layout = skeleton.bones[bone];
  Placement local;
  for (int i = 0; i < 12; ++i) local.m[i] = layout.parent_from_bone[i];
  for (int k = 0; k < layout.motion_count; ++k) {
    const cuda::JointMotion& t = skeleton.motions[layout.first_motion + k];
    const float amount = t.scale * (static_cast<float>(state[t.parameter]) - t.zero);
    if (t.slides) {
      slide(local, t.axis, amount);
    } else {
      turn(local, t.axis, amount);
    }
  }
  return local;
}

/// Writes world_from_bone of every bone for a normalised state. All threads of the team must call
/// it; on return, each sees all results.
template <class Team>
HYPOTRACK_PIXEL void pose_bones(const SkeletonLayout& skeleton, const double* state,
                                const Team& team, Placement* world_from_bone) {
  for (int level = 0; level < skeleton.levels; ++level) {
    for (int b = team.rank(); b < skeleton.bone_count; b += team.size()) {
      if (skeleton.level[b] != level) continue;
      const cuda::BoneLayout& bone = skeleton.bones[b];
      const Placement above = bone.parent < 0
                                  ? place_model(state + skeleton.models[bone.model].offset)
                                  : world_from_bone[bone.parent];
      world_from_bone[b] = compose(above, place_bone(skeleton, b, state).m);
    }
    team.sync();
  }
}

/// The bones of a scene's models, one model after the other, as plain data for kernels and state
/// terms. A model that poses itself contributes the bones of its data, which do not determine its
/// surface.
struct HYPOTRACK_API Skeleton {
  explicit Skeleton(const Scene& scene);
  /// Takes the bones of a single model; its parameters are the state.
  explicit Skeleton(const ModelData& data);

  /// Returns a view of this object, which must outlive it.
  SkeletonLayout layout() const;

  std::vector<cuda::ModelLayout> models;
  std::vector<cuda::BoneLayout> bones;
  std::vector<cuda::JointMotion> motions;
  std::vector<std::int32_t> level;  ///< depth of every bone in the hierarchy; 0 for a root

 private:
  void add(const ModelData& data, int offset);
};

}  // namespace hypotrack
