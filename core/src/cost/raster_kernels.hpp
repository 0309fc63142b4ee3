#pragma once

#include <cstddef>
#include <cstdint>

#include "hypotrack/export.hpp"
#include "scene/simd_kernels.hpp"

// The vectorised inner loops of the CPU renderer, behind plain data, compiled once per instruction
// set and chosen at run time. Arrays named `aligned` begin at multiples of 64 bytes.
//
// Wherever there is a fused multiply-add, vertices, coverage and inverse depths are the same to the
// last bit, on the GPU as well (hypotrack/cuda/{vertices,cull,fill}.cuh): the same operations on
// the same numbers, fused alike. Who changes one side changes the other.
namespace hypotrack {

/// A vertex is drawn if its depth is within these bounds (metres) and it lies within kGuard pixels
/// of the tile's origin in every view that shares its record. Triangles with another vertex are
/// dropped. So nothing that follows meets NaN, infinity or overflow.
inline constexpr float kNear = 0.01f;
inline constexpr float kFar = 1000.0f;
inline constexpr float kGuard = 1 << 20;

/// A camera looking at points given in the frame of the first one.
struct ViewProjection {
  float camera_from_first[12];  ///< 3x4 row-major
  float fx, fy, cx, cy;
  int width, height, stride;  ///< of the tile; stride is a multiple of kBlock
};

/// Smallest and largest coordinates of the vertices that can be drawn; low > high: none can.
struct PixelRange {
  float low_x, high_x, low_y, high_y;
};

/// Projects `count` (a multiple of kBlock) points into one view.
HYPOTRACK_API void project_view(const float* x, const float* y, const float* z, std::size_t count,
                                const ViewProjection& view, float* records, PixelRange& range);

/// Projects into both views of a rectified pair: y and 1/z are the same in both. `ranges` has two.
HYPOTRACK_API void project_pair(const float* x, const float* y, const float* z, std::size_t count,
                                const ViewProjection* views, float* records, PixelRange* ranges);

/// Triangles that may cover pixel centres are sorted by size: the i-th list has those whose pixels
/// fit into a square of kBoxSizes[i] and that no edge of the tile but the left and the top cuts,
/// the last list the rest.
inline constexpr int kBoxSizes[] = {2, 3, 5, 8};
inline constexpr int kSizeClasses = 5;

/// Visible triangles of one view. Each list has room for all triangles and kBlock more.
struct VisibleTriangles {
  std::uint32_t* list[kSizeClasses] = {};
  std::size_t count[kSizeClasses] = {};
};

/// Appends the visible triangles of a range for one view (`pair` false) or for both views of a
/// rectified pair.
HYPOTRACK_API void cull_triangles(const std::uint32_t* corners, const TriangleRange& range,
                                  const float* records, const ViewProjection* views, bool pair,
                                  VisibleTriangles* visible);

/// Draws visible triangles into an inverse-depth tile (`stride` x height floats, aligned): the
/// larger 1/z wins. `second` draws a rectified pair's second view. `degenerate` is the number of a
/// triangle without area; it fills up the lists, which therefore change.
HYPOTRACK_API void draw_triangles(const std::uint32_t* corners, std::uint32_t degenerate,
                                  const float* records, bool second, const ViewProjection& view,
                                  VisibleTriangles& visible, float* tile);

/// Sets the pixels of a tile with x0 <= x < x1, y0 <= y < y1 to zero, where all others are zero
/// already.
HYPOTRACK_API void clear_pixels(float* tile, int stride, int x0, int y0, int x1, int y1);

}  // namespace hypotrack
