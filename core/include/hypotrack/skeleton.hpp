#pragma once

#include <cstdint>
#include <vector>

#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "hypotrack/skeleton_pose.hpp"

namespace hypotrack {

/// The bones of a scene's models, one model after the other, as plain numbers: what kernels and
/// terms of the state pose. Models that pose themselves have the bones of their data, which do not
/// say where their surface is.
struct HYPOTRACK_API Skeleton {
  explicit Skeleton(const Scene& scene);
  /// Of a single model, whose parameters are the state.
  explicit Skeleton(const ModelData& data);

  /// Points into this object.
  SkeletonLayout layout() const;

  std::vector<cuda::ModelLayout> models;
  std::vector<cuda::BoneLayout> bones;
  std::vector<cuda::Turn> turns;
  std::vector<std::int32_t> level;  ///< of every bone: 0 where there is no parent

 private:
  void add(const ModelData& data, int offset);
};

}  // namespace hypotrack
