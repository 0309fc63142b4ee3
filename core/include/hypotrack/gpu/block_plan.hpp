#pragma once

#include <algorithm>
#include <cstdint>

#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::cuda {

/// Layout of a posed hypothesis in a block's shared memory; offsets in floats.
struct PoseMemory {
  int point;     ///< the search point in single precision
  int state;     ///< the decoded state
  int models;    ///< a 3x4 matrix per model: first_from_model
  int drawable;  ///< per model 0, or NaN if it cannot be drawn
  int locals;    ///< a 3x4 matrix per bone: parent_from_bone
  int bones;     ///< a 3x4 matrix per bone: first camera from the bind pose's vertices
  int model_layouts, bone_layouts, motions;  ///< of the scene
};

/// Numbers that a particle stores per dimension, in double precision.
inline constexpr int kParticleNumbers = 8;

/// Bits of an empty slot of BlockPlan::band_sums, which no arithmetic produces.
inline constexpr std::uint64_t kEmptySlot = ~std::uint64_t{0};

/// Distribution of a hypothesis over blocks of threads, and the layout of a block's shared memory
/// (offsets in floats, multiples of four).
struct BlockPlan {
  int threads = 0;
  int bands = 1;  ///< blocks per hypothesis; each draws and scores a band of rows
  int shared_bytes = 0;
  bool vertices_in_shared = true;  ///< otherwise in `vertex_scratch`
  int chunk = 0;                   ///< triangles culled at a time
  int depth_capacity = 0;          ///< floats of the z-buffers
  PoseMemory pose{};
  int particle = 0;  ///< kParticleNumbers arrays, one number per dimension each
  int vertices = 0, vertex_stride = 0, list = 0, sums = 0, depth = 0;
  int heights = -1;  ///< extra copy of every vertex's y, relative to `vertices`; -1 = none
  /// True if the scene's vertices or triangles are copied to shared memory while the previous
  /// kernel still runs.
  bool stages_vertices = false, stages_triangles = false;
  /// True if the staged vertices stay there for all hypotheses of a search. Otherwise texels
  /// overwrite them.
  bool keeps_vertices = false;
  int staged_vertices = 0, staged_triangles = 0;
  int end = 0;  ///< end of the block's memory; once the vertices are placed, texels fit between the
                ///< last z-buffer pixel and here

  float* vertex_scratch = nullptr;  ///< 4 * vertex_stride floats per block
  float* depth_scratch = nullptr;   ///< depth_scratch_size floats per block, or null
  int depth_scratch_size = 0;
  double* band_sums = nullptr;  ///< with several bands: one slot per block and sum (join_bands)
};

/// Input of plan_blocks().
struct PlanRequest {
  SceneLayout scene;
  DeviceLimits limits;
  std::int64_t count = 0;  ///< hypotheses per batch
  int tile_width = 0;      ///< of the widest view
  int tile_height = 0;
  int tiles_at_once = 1;  ///< z-buffers needed at the same time
  bool may_split = true;  ///< allows several bands
  int sums = 0;
  bool texels = false;  ///< whether room for texels is useful
  bool alone = false;   ///< no other kernel starts while the block runs (a whole search)
};

inline constexpr int kMostThreads = 1024;

/// Returns the least depth capacity of a usable plan: one row of every z-buffer.
inline int least_depth_capacity(int tiles_at_once, int tile_width) {
  return tiles_at_once * tile_width + 4;
}

namespace detail {

inline int rounded(int floats) { return (floats + 3) / 4 * 4; }

// Shared memory per block that the system and the kernels' static variables take.
inline constexpr int kReservedBytes = 1024 + 1024;

// Shared memory left for an optimizer's kernel that starts early, beside a block that takes the
// rest.
inline constexpr int kLeftToOthers = 20 * 1024;

/// Lays out a posed hypothesis from offset `end` on and moves `end` behind it.
inline PoseMemory lay_out_pose(const SceneLayout& scene, int& end) {
  const auto take = [&](int floats) {
    const int begin = end;
    end += rounded(floats);
    return begin;
  };
  const auto take_items = [&](std::size_t size, int count) {
    return take(static_cast<int>(size / sizeof(float)) * count);
  };
  PoseMemory pose{};
  pose.point = take(scene.dimension);
  pose.state = take(scene.dimension);
  pose.models = take(12 * scene.model_count);
  pose.drawable = take(scene.model_count);
  pose.locals = take(12 * scene.bone_count);
  pose.bones = take(12 * scene.bone_count);
  pose.model_layouts = take_items(sizeof(ModelLayout), scene.model_count);
  pose.bone_layouts = take_items(sizeof(BoneLayout), scene.bone_count);
  pose.motions = take_items(sizeof(JointMotion), scene.motion_count);
  return pose;
}

/// Plans a block that may use `bytes` of shared memory; the z-buffers take what is left.
inline BlockPlan lay_out(const PlanRequest& r, int threads, int bands, int bytes) {
  BlockPlan p;
  p.threads = threads;
  p.bands = bands;
  // With bands, blocks wait for one another after every chunk, so one chunk is best.
  p.chunk = std::min(r.scene.triangle_count, bands > 1 ? 8192 : 4096);
  p.vertex_stride = r.scene.vertex_count;
  int end = 0;
  const auto take = [&](int floats) {
    const int begin = end;
    end += rounded(floats);
    return begin;
  };
  p.pose = lay_out_pose(r.scene, end);
  p.particle = take(2 * kParticleNumbers * r.scene.dimension);
  p.sums = take(r.sums * (kMostThreads / 32));
  p.list = take(p.chunk);  // two 16-bit entries per triangle
  const int floats = bytes / 4;
  // One row of every z-buffer must fit; reserve at least a third of the memory for z-buffers.
  const int least_depth =
      rounded(std::max(least_depth_capacity(r.tiles_at_once, r.tile_width), floats / 3));
  p.vertices_in_shared = end + 4 * p.vertex_stride + least_depth <= floats;
  p.vertices = p.vertices_in_shared ? take(4 * p.vertex_stride) : 0;
  if (p.vertices_in_shared && bands > 1 && end + p.vertex_stride + least_depth <= floats) {
    p.heights = take(p.vertex_stride) - p.vertices;
  }
  const int rows = (r.tile_height + bands - 1) / bands;
  const std::int64_t wanted = std::int64_t{rows} * r.tiles_at_once * r.tile_width + 8;
  const int vertices = static_cast<int>(sizeof(VertexLayout) / 4) * r.scene.vertex_count;
  const int triangles = static_cast<int>(sizeof(PackedTriangle) / 4) * r.scene.triangle_count;
  // A band is rarely as wide as its tile. A whole hypothesis gains less from staging, since another
  // block works beside it, and staging would split its drawing into more pieces.
  const std::int64_t needed = bands > 1 ? std::min<std::int64_t>(wanted, least_depth) : wanted;
  const std::int64_t staged = end + triangles + needed + 8;
  p.stages_triangles = p.vertices_in_shared && staged <= floats;
  p.stages_vertices = p.stages_triangles && staged + vertices <= floats;
  p.staged_triangles = p.stages_triangles ? take(triangles) : 0;
  // This must leave room for z-buffers and 8-byte texels of all rows of a band.
  p.keeps_vertices = r.alone && r.texels && bands > 1 && p.stages_vertices &&
                     end + rounded(vertices) + 3 * wanted <= floats;
  if (p.keeps_vertices) p.staged_vertices = take(vertices);
  const int behind = p.stages_vertices && !p.keeps_vertices ? rounded(vertices) : 0;
  p.depth = end;
  p.depth_capacity = static_cast<int>(
      std::min<std::int64_t>(rounded(static_cast<int>(wanted)), (floats - end - behind) / 4 * 4));
  end += p.depth_capacity;
  if (behind > 0) p.staged_vertices = take(vertices);
  if (r.texels && bands > 1) {
    end = std::max(end, (floats - (r.alone ? 0 : kLeftToOthers / 4)) / 4 * 4);
  }
  p.end = end;
  p.shared_bytes = 4 * end;
  return p;
}

}  // namespace detail

/// Plans how a batch is distributed over the device. A few hypotheses are split into bands, so that
/// every multiprocessor has one block. Many are drawn whole, with two blocks per multiprocessor, so
/// that one works while the other waits.
inline BlockPlan plan_blocks(const PlanRequest& r) {
  const auto slots = static_cast<std::int64_t>(r.limits.multiprocessors);
  if (r.may_split && 2 * r.count <= slots) {
    const int bands = static_cast<int>(std::min<std::int64_t>(slots / r.count, kMostBands));
    return detail::lay_out(r, kMostThreads, bands,
                           r.limits.shared_bytes_per_block - detail::kReservedBytes);
  }
  const int half = r.limits.shared_bytes_per_multiprocessor / 2 - detail::kReservedBytes;
  const BlockPlan two =
      detail::lay_out(r, kMostThreads / 2, 1,
                      std::min(half, r.limits.shared_bytes_per_block - detail::kReservedBytes));
  if (two.vertices_in_shared) return two;
  return detail::lay_out(r, kMostThreads, 1,
                         r.limits.shared_bytes_per_block - detail::kReservedBytes);
}

}  // namespace hypotrack::cuda
