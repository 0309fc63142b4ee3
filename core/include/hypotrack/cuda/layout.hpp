#pragma once

#include <cstdint>

#include "hypotrack/pixel.hpp"

/// What CUDA kernels see of scenes, frames and hypotheses: plain data, shared between .cu files and
/// C++. Pointers are to device memory. Matrices are 3x4, row by row. Units as everywhere: metres,
/// radians, pixel centres at integers.
namespace hypotrack::cuda {

inline constexpr int kMaxViews = 4;
inline constexpr int kMostBands = 16;  ///< thread blocks that share a hypothesis

/// A rotation of a bone by a parameter (BoneRotation).
struct Turn {
  float axis[3];
  float scale;
  float zero;
  std::int32_t parameter;  ///< index into the scene's state
};

struct BoneLayout {
  std::int32_t parent;  ///< index into the scene's bones; -1: the pose of its model
  std::int32_t model;
  std::int32_t first_turn;  ///< its turns, in the order in which they apply
  std::int32_t turn_count;
  float parent_from_bone[12];  ///< at the bind pose
  float bone_from_model[12];   ///< at the bind pose
};

struct ModelLayout {
  std::int32_t offset;  ///< of its first parameter in the state
  std::int32_t dimension;
};

/// A vertex and up to four bones that hold it. Unused influences have weight 0 and bone 0.
struct alignas(8) VertexLayout {
  float position[3];        ///< model frame at the bind pose
  std::uint8_t bone[4];     ///< indices into the scene's bones
  std::uint16_t weight[4];  ///< in units of 1 / kWholeWeight; they add up to it
};
inline constexpr int kWholeWeight = 65535;
inline constexpr int kMostBones = 256;

/// Three vertex indices of 21 bits each, lowest first, and one bit: drawn from both sides.
using PackedTriangle = std::uint64_t;
inline constexpr int kVertexBits = 21;
inline constexpr std::uint32_t kVertexMask = (1u << kVertexBits) - 1;

/// A scene, uploaded once.
struct SceneLayout {
  std::int32_t dimension;  ///< of the state
  std::int32_t model_count;
  std::int32_t bone_count;
  std::int32_t turn_count;
  std::int32_t vertex_count;
  std::int32_t triangle_count;
  const ModelLayout* models;
  const BoneLayout* bones;
  const Turn* turns;
  const VertexLayout* vertices;
  const PackedTriangle* triangles;
};

/// The camera of a tile, looking at points in the frame of the first view's camera.
struct ViewLayout {
  float view_from_first[12];
  float fx, fy, cx, cy;
  std::int32_t width, height;
};

/// A frame's cameras; in device memory, so that kernels that were captured into a graph find the
/// current ones.
struct alignas(16) FrameLayout {
  std::int32_t view_count;
  std::int32_t pair;  ///< two views that share y and 1/z: x_right = x_left + a constant + f b / z
  ViewLayout views[kMaxViews];
  float first_from_world[12];
  StereoMap maps[2];  ///< from view 0 into 1 and from 1 into 0; undefined for a single view
  /// How work on a hypothesis is spread over the rows that it covers, from the share 0 to the share
  /// 1 of them: how far down k / kMostBands of it end. Rises from 0 to 1.
  float work_ends[kMostBands + 1];
};

/// Pixels of a tile, row by row without gaps: blue | green << 8 | red << 16 | flags << 24.
inline constexpr std::uint32_t kValidFlag = 1u << 24;       ///< comes from inside the image
inline constexpr std::uint32_t kForegroundFlag = 2u << 24;  ///< within the mask (and valid)
struct TileLayout {
  std::int32_t width, height;
  const std::uint32_t* pixels;
  const float* depth;  ///< metres, 0: not measured; null if the view has no depth
};

/// Hypotheses to be evaluated. A point is a column of the search space: the scene's state, where a
/// model's quaternion may be replaced by a rotation vector that is applied to the prior's rotation.
struct BatchLayout {
  const double* points;
  std::int64_t count;
  double* costs;        ///< one per point
  double weight;        ///< of this objective
  const double* prior;  ///< with rotation vectors: the state around which they turn; otherwise null
  bool add;             ///< add to the costs that are there instead of overwriting them
};

/// Where an objective writes the residuals of a batch.
struct ResidualLayout {
  float* residuals;     ///< this objective's, of the first hypothesis
  std::int64_t stride;  ///< from one hypothesis to the next
  float factor;         ///< what they are multiplied by: the root of the objective's weight
};

}  // namespace hypotrack::cuda
