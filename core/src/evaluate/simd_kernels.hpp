#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hypotrack/export.hpp"

// The vectorised inner loops of the CPU renderer, behind plain data. They are compiled once per
// instruction set and selected at run time. Arrays named `aligned` start at multiples of 64 bytes.
//
// With fused multiply-add, vertices, coverage and inverse depths are bit-identical on CPU and GPU
// (hypotrack/cuda/{vertices,cull,fill}.cuh). Both sides use the same operations with the same
// fusing. Whoever changes one side must change the other.
namespace hypotrack {

/// Number of vertices in a block, for any vector width of the machine.
inline constexpr int kBlock = 16;

/// Depth bounds (metres) and largest pixel distance of drawable vertices. The distance is from the
/// tile's origin, in every view that shares the vertex' record. Triangles with any other vertex are
/// dropped, so that later steps meet no NaN, infinity or overflow.
inline constexpr float kNear = 0.01f;
inline constexpr float kFar = 1000.0f;
inline constexpr float kGuard = 1 << 20;

/// Linear blend skinning prepared for vectors. Vertices are sorted by their bones, in blocks. Each
/// block has one entry per bone that moves any of its vertices, in rising order.
struct SkinBlocks {
  std::vector<std::uint32_t> first_entry;  ///< per block, and the end of the last
  std::vector<std::uint32_t> bone;         ///< per entry
  /// Per block, 3 x kBlock floats: x, y, z in the model's frame at the bind pose.
  const float* aligned_positions = nullptr;
  /// Per entry, kBlock floats: integer multiples of weight_unit.
  const float* aligned_weights = nullptr;
  float weight_unit = 1;
};

/// Skins all blocks. Writes x, y, z (kBlock floats per block, aligned) in the frame that `bones`,
/// 3x4 row-major matrices from the bind pose, map to.
HYPOTRACK_API void skin_blocks(const SkinBlocks& blocks, const float* bones, float* x, float* y,
                               float* z);

/// Bounds of points on the plane z = 1 of a camera, and the smallest z. `nearest` is NaN if any
/// coordinate is not finite.
struct PlaneBounds {
  float x0, x1, y0, y1;
  float nearest;
};

/// Computes the bounds of `count` (a multiple of kBlock) aligned points in a camera (3x4
/// row-major).
HYPOTRACK_API void bound_points(const float* x, const float* y, const float* z, std::size_t count,
                                const float* camera_from_first, PlaneBounds& bounds);

/// A camera for points in the frame of the first one.
struct ViewProjection {
  float camera_from_first[12];  ///< 3x4 row-major
  float fx, fy, cx, cy;
  int width, height, stride;  ///< of the tile; stride is a multiple of kBlock
};

/// Range of the drawable vertices' coordinates; low > high if there are none.
struct PixelRange {
  float low_x, high_x, low_y, high_y;
};

/// Floats of a projected vertex' record: x, y (pixels), 1/z (1/m, 0 = do not draw), and x in the
/// second view of a rectified pair.
inline constexpr int kRecord = 4;

/// Projects `count` (a multiple of kBlock) points into one view.
HYPOTRACK_API void project_view(const float* x, const float* y, const float* z, std::size_t count,
                                const ViewProjection& view, float* records, PixelRange& range);

/// Projects points into both views of a rectified pair, which share y and 1/z. `ranges` has two
/// elements.
HYPOTRACK_API void project_pair(const float* x, const float* y, const float* z, std::size_t count,
                                const ViewProjection* views, float* records, PixelRange* ranges);

/// A range of triangles. A triangle's corners are offsets into the records: 4 numbers, the last
/// unused. The number of triangles is a multiple of kBlock; the last one is degenerate.
struct TriangleRange {
  std::uint32_t begin = 0, end = 0;  ///< triangles, multiples of kBlock
  bool two_sided = true;             ///< false: back faces are dropped
};

/// Largest extents of the size classes of visible triangles. Class i holds triangles that fit into
/// a square of kBoxSizes[i] pixels and that no right or bottom edge of the tile cuts. The last
/// class holds the rest.
inline constexpr int kBoxSizes[] = {2, 3, 5, 8};
inline constexpr int kSizeClasses = 5;

/// Visible triangles of one view. Each list has room for all triangles plus kBlock.
struct VisibleTriangles {
  std::uint32_t* list[kSizeClasses] = {};
  std::size_t count[kSizeClasses] = {};
};

/// Appends the visible triangles of a range for one view or, with `pair`, for both views of a
/// rectified pair.
HYPOTRACK_API void cull_triangles(const std::uint32_t* corners, const TriangleRange& range,
                                  const float* records, const ViewProjection* views, bool pair,
                                  VisibleTriangles* visible);

/// Draws visible triangles into an inverse-depth tile (`stride` x height floats, aligned); the
/// larger 1/z wins. `second` selects a rectified pair's second view. `degenerate` is the index of a
/// triangle without area that pads the lists, which are changed.
HYPOTRACK_API void draw_triangles(const std::uint32_t* corners, std::uint32_t degenerate,
                                  const float* records, bool second, const ViewProjection& view,
                                  VisibleTriangles& visible, float* tile);

/// Sets the pixels x0 <= x < x1, y0 <= y < y1 of a tile to zero; all others must already be zero.
HYPOTRACK_API void clear_pixels(float* tile, int stride, int x0, int y0, int x1, int y1);

/// Returns the name of the instruction set in use: `AVX3`.
HYPOTRACK_API const char* simd_target();

/// Returns the instruction sets of the compiled kernels, as Highway's bits.
HYPOTRACK_API std::int64_t compiled_simd_targets();

}  // namespace hypotrack
