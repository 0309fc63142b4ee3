#pragma once

#include <cstdint>
#include <vector>

#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/skeleton_pose.hpp"

namespace hypotrack {

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
