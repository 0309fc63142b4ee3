#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hypotrack/export.hpp"

// The vectorised inner loops that pose and bound a scene, behind plain data, compiled once per
// instruction set and chosen at run time. Arrays named `aligned` begin at multiples of 64 bytes.
// Posed vertices are the same to the last bit on the GPU (hypotrack/cuda/vertices.cuh) wherever
// there is a fused multiply-add. A change of one side needs the same change of the other.
namespace hypotrack {

/// Vertices are handled in blocks of this many, whatever the width of the machine's vectors.
inline constexpr int kBlock = 16;

/// Linear blend skinning prepared for vectors: the vertices, ordered by the bones that hold them,
/// in blocks; per block a few entries, one per bone that holds any of its vertices, in rising
/// order.
struct SkinBlocks {
  std::vector<std::uint32_t> first_entry;  ///< per block, and one more at the end
  std::vector<std::uint32_t> bone;         ///< per entry
  /// Per block, 3 x kBlock floats: x, y, z in the model's frame at the bind pose.
  const float* aligned_positions = nullptr;
  /// Per entry, kBlock floats: whole numbers of weight_unit.
  const float* aligned_weights = nullptr;
  float weight_unit = 1;
};

/// Moves all blocks: x, y, z (each kBlock per block, aligned) in the frame that `bones` lead to
/// from the bind pose. `bones` holds 3x4 row-major matrices.
HYPOTRACK_API void skin_blocks(const SkinBlocks& blocks, const float* bones, float* x, float* y,
                               float* z);

/// Where points lie on the plane z = 1 of a camera, and the smallest z: NaN if any coordinate is
/// not finite.
struct PlaneBounds {
  float x0, x1, y0, y1;
  float nearest;
};

/// Bounds `count` (a multiple of kBlock) aligned points, seen by a camera (3x4 row-major).
HYPOTRACK_API void bound_points(const float* x, const float* y, const float* z, std::size_t count,
                                const float* camera_from_first, PlaneBounds& bounds);

/// A projected vertex is a record of four floats: x, y (pixels), 1/z (1/m; 0: not to be drawn), and
/// x in the second view of a rectified pair.
inline constexpr int kRecord = 4;

/// Corners of triangles as offsets into the records: 4 numbers per triangle, the last unused. The
/// number of triangles is a multiple of kBlock; the very last one is degenerate.
struct TriangleRange {
  std::uint32_t begin = 0, end = 0;  ///< triangles, multiples of kBlock
  bool two_sided = true;             ///< false: those seen from behind are left out
};

/// Name of the instruction set in use: `AVX3`.
HYPOTRACK_API const char* simd_target();

/// The instruction sets that there are kernels for: Highway's bits.
HYPOTRACK_API std::int64_t compiled_simd_targets();

}  // namespace hypotrack
