#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/gpu/skeleton.hpp"

// The vectorised inner loops that pose and bound a scene, behind plain data, compiled once per
// instruction set and chosen at run time. Arrays named `aligned` begin at multiples of 64 bytes.
// Posed vertices are the same to the last bit on the GPU (hypotrack/gpu/vertices.cuh) wherever
// there is a fused multiply-add. A change of one side needs the same change of the other.
namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Vertices are handled in blocks of this many, whatever the width of the machine's vectors.
inline constexpr int kBlock = 16;

/// Linear blend skinning prepared for vectors. Vertices are sorted by their bones, in blocks. Each
/// block has one entry per bone that moves any of its vertices, in rising order.
struct SkinBlocks {
  std::vector<std::uint32_t> first_entry;  ///< per block, and one more at the end
  std::vector<std::uint32_t> bone;         ///< per entry
  /// Per block, 3 x kBlock floats: x, y, z in the model's frame at the bind pose.
  const float* aligned_positions = nullptr;
  /// Per entry, kBlock floats: whole numbers of weight_unit.
  const float* aligned_weights = nullptr;
  float weight_unit = 1;
};

/// Skins all blocks. Writes x, y, z (kBlock floats per block, aligned) in the frame that `bones`,
/// 3x4 row-major matrices from the bind pose, map to.
void skin_blocks(const SkinBlocks& blocks, const float* bones, float* x, float* y, float* z);

/// Bounds of points on the plane z = 1 of a camera, and the smallest z. `nearest` is NaN if any
/// coordinate is not finite.
struct PlaneBounds {
  float x0, x1, y0, y1;
  float nearest;
};

/// Computes the bounds of `count` (a multiple of kBlock) aligned points in a camera (3x4
/// row-major).
void bound_points(const float* x, const float* y, const float* z, std::size_t count,
                  const float* camera_from_first, PlaneBounds& bounds);

/// Floats of a projected vertex' record: x, y (pixels), 1/z (1/m, 0 = do not draw), and x in the
/// second view of a rectified pair.
inline constexpr int kRecord = 4;

/// Corners of triangles as offsets into the records: 4 numbers per triangle, the last unused. The
/// number of triangles is a multiple of kBlock; the very last one is degenerate.
struct TriangleRange {
  std::uint32_t begin = 0, end = 0;  ///< triangles, multiples of kBlock
  bool two_sided = true;             ///< false: those seen from behind are left out
};

/// Returns the name of the instruction set in use: `AVX3`.
const char* simd_target();

/// Returns the instruction sets of the compiled kernels, as Highway's bits.
std::int64_t compiled_simd_targets();

/// Writes the 3x4 matrix, row by row, from the bind pose to the first camera for every bone of one
/// model. The single-precision operations equal the GPU's (hypotrack/gpu/pose.cuh), so that
/// results are bit-identical wherever there is a fused multiply-add. `state` is the model's,
/// normalised; `first_from_world` is 3x4, row by row. `locals` is scratch for 12 numbers per bone.
void pose_skeleton(const SkeletonLayout& skeleton, const float* state,
                   const float* first_from_world, float* locals, float* first_from_bind);

}  // namespace internal
}  // namespace hypotrack
