#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "cost/draw/raster_kernels.hpp"
#include "scene/scene_plan.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Number of neighbouring vertices that share a list of the parameters that move them.
inline constexpr std::size_t kMoverBlock = 8;

/// A hypothesis drawn in one view, with its projected vertices at D neighbouring points.
struct DrawnView {
  const ScenePlan* plan = nullptr;
  const ViewProjection* view = nullptr;
  const VisibleTriangles* visible = nullptr;
  bool second = false;             ///< second view of a rectified pair
  const float* tile = nullptr;     ///< inverse depth, `view->stride` x height
  const float* records = nullptr;  ///< of the drawn vertices
  /// D records with one parameter changed, and 1 / the change.
  const float* const* beside = nullptr;
  const float* per_step = nullptr;
  int dimension = 0;
  /// For each kMoverBlock vertices: the parameters that move any of them.
  const std::vector<int>* movers = nullptr;
};

/// A term's residuals of a view's pixels and their slopes d r / d(1/z), rows without gaps, both to
/// be multiplied by `factor`.
struct PixelSlopes {
  const float* residuals = nullptr;
  const float* slopes = nullptr;
  float factor = 1;
};

/// Rows of a tile: first <= y < end.
struct TileRows {
  int first = 0, end = 0;
};

/// Visible triangles of each band of rows, in the order of the visible ones.
using BandTriangles = std::vector<std::vector<std::uint32_t>>;

/// Finds the visible triangles that meet each band. `rows`: the first row of each band, and the
/// last band's end.
void find_triangles(const DrawnView& drawn, std::span<const int> rows, BandTriangles& bands);

/// Sums J^T J and J^T r of the pixel residuals of all terms, from slopes and the motion of the
/// drawn surface.
///
/// Interior pixels: a pixel looks along a fixed ray. When the surface moves, its inverse depth w on
/// the ray changes by dw = w' - grad w . p'. Here p' and w' are the motions of the surface point in
/// the image and of its inverse depth. p', w' and w are linear within each triangle's image. The
/// row of J is slope * dw.
///
/// Silhouettes: when a silhouette moves, pixels change between the surface and its background. Let
/// p be the last pixel on the surface and q the first one beyond. Per pixel of outward motion, the
/// sum of squares changes by r_p^2 - r_q^2. This is the boundary integral of a shape derivative;
/// the staircase of pixel edges, each with the motion across it, has the same integral. A residual
/// that changes from r_q to r_p over `blur` pixels has the row (r_p - r_q) / sqrt(blur) and the
/// residual (r_p + r_q) / 2 sqrt(blur). They give the exact gradient and a curvature that decreases
/// with the blur.
///
/// The terms' rows at a pixel are multiples f_t of one row, with residuals r_t. One row times
/// f = sqrt(sum f_t^2), with the residual sum f_t r_t / f, has the same products.
class PixelRows {
 public:
  /// Sums over the pixels of some rows of a view, whose size is the tile's, and of triangles that
  /// meet them (find_triangles()). `blur`: pixels over which a crossing silhouette changes a
  /// residual.
  void sum(const DrawnView& drawn, std::span<const PixelSlopes> terms, float blur, TileRows rows,
           std::span<const std::uint32_t> triangles);

  /// Returns the number of columns of the sums: D + 1, rounded up to whole vectors.
  std::size_t columns() const { return columns_; }
  /// Returns J^T J, with r as the last column of J: columns() x columns() numbers, valid where row
  /// <= column < D + 1.
  const std::vector<float>& sums() const { return sums_; }

 private:
  void join_terms(std::span<const PixelSlopes> terms, int width, TileRows rows);

  std::size_t columns_ = 0;
  std::vector<float> sums_;
  Eigen::ArrayXf slopes_, residuals_;  // per pixel of the rows, of all terms together
  std::vector<std::uint8_t> taken_;    // per pixel of the rows: whether its triangle is known
  std::vector<std::uint8_t>
      known_;             // per vertex: whether its motion is computed and whether it moves
  AlignedFloats motion_;  // per vertex 3 x columns: of x, y and 1/z
  std::size_t motion_size_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
