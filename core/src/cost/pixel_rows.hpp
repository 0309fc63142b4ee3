#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cost/raster_kernels.hpp"
#include "hypotrack/export.hpp"
#include "scene/scene_plan.hpp"

namespace hypotrack {

/// A hypothesis as one view sees it, and how the vertices on its screen move with each of D
/// numbers.
struct DrawnView {
  const ScenePlan* plan = nullptr;
  const ViewProjection* view = nullptr;
  const VisibleTriangles* visible = nullptr;
  bool second = false;             ///< of a rectified pair
  const float* tile = nullptr;     ///< inverse depth, `view->stride` x height
  const float* records = nullptr;  ///< of its vertices
  /// Records with one number changed, and 1 / by how much (0: left out). D of them.
  const float* const* beside = nullptr;
  const float* per_step = nullptr;
  int dimension = 0;
};

/// Residuals of a view's pixels and their slopes d r / d(1/z), rows without gaps.
struct PixelSlopes {
  const float* residuals = nullptr;
  const float* slopes = nullptr;
  float blur = 1;  ///< pixels over which a passing silhouette changes a residual
};

/// Sums up J^T J and J^T r of pixels' residuals, from slopes and the motion of what is drawn.
///
/// A pixel looks along a ray that does not move. Where a surface moves, its inverse depth w on the
/// ray changes by dw = w' - grad w . p' with p' and w' the motions of the surface point on the
/// screen and of its inverse depth; both, and w itself, are linear on the screen in each triangle.
/// That makes the row slope * dw.
///
/// Where a silhouette moves, pixels change from what is behind it to what is before it. With p the
/// last pixel before and q the first behind, the sum of squares changes by (r_p^2 - r_q^2) per
/// pixel of the way outwards (the boundary integral of a shape derivative; a staircase of pixel
/// edges has the right integral, each edge with the motion across it). A residual that changes from
/// r_q to r_p over `blur` pixels makes the row (r_p - r_q) / sqrt(blur) with the residual
/// (r_p + r_q) / 2 sqrt(blur): the right gradient, and a curvature that falls with the blur.
class HYPOTRACK_API PixelRows {
 public:
  /// Begins a view; what it refers to must live until the last add(). `width` and `height` of the
  /// tile come from the view.
  void begin(const DrawnView& drawn);

  /// Adds the rows of a term to the sums.
  void add(const PixelSlopes& term);

  /// Number of columns of the sums: D + 1, rounded up to whole vectors.
  std::size_t columns() const { return columns_; }
  /// columns() x columns() numbers; valid where row <= column < D + 1. J^T J, with r as the last
  /// column of J.
  const std::vector<float>& sums() const { return sums_; }

 private:
  DrawnView drawn_;
  std::size_t columns_ = 0;
  std::vector<float> sums_;
  std::vector<std::uint8_t> taken_;  // per pixel: whether it has found its triangle
  std::vector<std::uint8_t> known_;  // per vertex: whether its motion is there
  AlignedFloats motion_;             // per vertex 3 x columns: of x, y and 1/z
  std::size_t motion_size_ = 0;
};

}  // namespace hypotrack
