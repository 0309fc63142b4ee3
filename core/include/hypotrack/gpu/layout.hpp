#pragma once

#include <cstdint>

#include "hypotrack/plugin/pixel.hpp"

/// Scenes, frames and hypotheses as plain data, shared by .cu files and C++. Pointers are to device
/// memory. Matrices are 3x4, row by row. Metres, radians, pixel centres at integers.
namespace hypotrack::cuda {

inline constexpr int kMaxViews = 4;
inline constexpr int kMostBands = 16;  ///< most thread blocks that share a hypothesis

/// The motion of a bone by a parameter (BoneMotion).
struct JointMotion {
  float axis[3];
  float scale;
  float zero;
  std::int32_t parameter;  ///< index into the scene's state
  std::int32_t slides;     ///< 1: a translation along the axis; 0: a rotation about it
};

/// A bone of a scene.
struct BoneLayout {
  std::int32_t parent;  ///< index into the scene's bones; -1 = its model's pose
  std::int32_t model;
  std::int32_t first_motion;  ///< its motions follow in the order in which they apply
  std::int32_t motion_count;
  float parent_from_bone[12];  ///< at the bind pose
  float bone_from_model[12];   ///< at the bind pose
};

/// A model of a scene: its part of the state.
struct ModelLayout {
  std::int32_t offset;  ///< index of its first parameter in the state
  std::int32_t dimension;
};

/// A vertex with up to four bone influences. Unused influences have weight 0 and bone 0.
struct alignas(8) VertexLayout {
  float position[3];        ///< model frame at the bind pose
  std::uint8_t bone[4];     ///< indices into the scene's bones
  std::uint16_t weight[4];  ///< in units of 1 / kUnitWeight; sum to kUnitWeight
};
inline constexpr int kUnitWeight = 65535;
inline constexpr int kMostBones = 256;

/// Three vertex indices of 21 bits, lowest first, and one bit for a two-sided triangle.
using PackedTriangle = std::uint64_t;
inline constexpr int kVertexBits = 21;
inline constexpr std::uint32_t kVertexMask = (1u << kVertexBits) - 1;

/// A scene on the device, uploaded once.
struct SceneLayout {
  std::int32_t dimension;  ///< of the state
  std::int32_t model_count;
  std::int32_t bone_count;
  std::int32_t motion_count;
  std::int32_t vertex_count;
  std::int32_t triangle_count;
  const ModelLayout* models;
  const BoneLayout* bones;
  const JointMotion* motions;
  const VertexLayout* vertices;
  const PackedTriangle* triangles;
};

/// The camera of a tile, for points in the frame of the first view's camera.
struct ViewLayout {
  float view_from_first[12];
  float fx, fy, cx, cy;
  std::int32_t width, height;
};

/// The cameras of a frame, in device memory, so that captured graphs read the current ones.
struct alignas(16) FrameLayout {
  std::int32_t view_count;
  std::int32_t pair;  ///< two views that share y and 1/z: x_right = x_left + constant + f b / z
  ViewLayout views[kMaxViews];
  float first_from_world[12];
  StereoMap maps[2];  ///< from view 0 to 1 and from 1 to 0; undefined for a single view
  /// Distribution of a hypothesis' work over its rows. Entry k is the share of the rows, from the
  /// top, that hold k / kMostBands of the work; rises from 0 to 1.
  float work_ends[kMostBands + 1];
};

/// Flags of a tile's pixel, which is blue | green << 8 | red << 16 | flags << 24.
inline constexpr std::uint32_t kValidFlag = 1u << 24;       ///< lies inside the source image
inline constexpr std::uint32_t kForegroundFlag = 2u << 24;  ///< inside the mask, and valid
/// The images of a tile on the device.
struct TileLayout {
  std::int32_t width, height;
  const std::uint32_t* pixels;  ///< row by row without gaps
  const float* depth;           ///< metres, 0 = not measured; null without depth
};

/// Hypotheses to evaluate. A point is the scene's state, or has a rotation vector in place of each
/// model's quaternion. The rotation vector applies to the prior's rotation.
struct BatchLayout {
  const double* points;
  std::int64_t count;
  double* costs;        ///< one per point
  double weight;        ///< weight of this objective
  const double* prior;  ///< with rotation vectors: the state about which they rotate; else null
  bool add;             ///< add to the costs instead of overwriting them
};

/// Memory for an objective's residuals of a batch.
struct ResidualLayout {
  float* residuals;     ///< first hypothesis, this objective's residuals
  std::int64_t stride;  ///< from one hypothesis to the next
  float factor;         ///< factor on the residuals: the root of the objective's weight
};

}  // namespace hypotrack::cuda
