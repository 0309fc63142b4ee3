#pragma once

#include <cstddef>
#include <cstdint>

#include "base/exported.hpp"
#include "scene/simd_kernels.hpp"

// The vectorised inner loops of the CPU renderer, behind plain data. They are compiled once per
// instruction set and selected at run time. Arrays named `aligned` start at multiples of 64 bytes.
//
// With fused multiply-add, vertices, coverage and inverse depths are bit-identical on CPU and GPU
// (hypotrack/gpu/{vertices,cull,fill}.cuh). Both sides use the same operations with the same
// fusing. Whoever changes one side must change the other.
namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Depth bounds (metres) and largest pixel distance of drawable vertices. The distance is from the
/// tile's origin, in every view that shares the vertex' record. Triangles with any other vertex are
/// dropped, so that later steps meet no NaN, infinity or overflow.
inline constexpr float kNear = 0.01f;
inline constexpr float kFar = 1000.0f;
inline constexpr float kGuard = 1 << 20;

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

/// Projects `count` (a multiple of kBlock) points into one view.
void project_view(const float* x, const float* y, const float* z, std::size_t count,
                  const ViewProjection& view, float* records, PixelRange& range);

/// Projects points into both views of a rectified pair, which share y and 1/z. `ranges` has two
/// elements.
void project_pair(const float* x, const float* y, const float* z, std::size_t count,
                  const ViewProjection* views, float* records, PixelRange* ranges);

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
void cull_triangles(const std::uint32_t* corners, const TriangleRange& range, const float* records,
                    const ViewProjection* views, bool pair, VisibleTriangles* visible);

/// Draws visible triangles into an inverse-depth tile (`stride` x height floats, aligned); the
/// larger 1/z wins. `second` selects a rectified pair's second view. `degenerate` is the index of a
/// triangle without area that pads the lists, which are changed.
void draw_triangles(const std::uint32_t* corners, std::uint32_t degenerate, const float* records,
                    bool second, const ViewProjection& view, VisibleTriangles& visible,
                    float* tile);

/// Sets the pixels x0 <= x < x1, y0 <= y < y1 of a tile to zero; all others must already be zero.
void clear_pixels(float* tile, int stride, int x0, int y0, int x1, int y1);

}  // namespace internal
}  // namespace hypotrack
