// Included once per instruction set: no #pragma once.
#if defined(HYPOTRACK_VIEW_PIXELS_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef HYPOTRACK_VIEW_PIXELS_INL_HPP_
#undef HYPOTRACK_VIEW_PIXELS_INL_HPP_
#else
#define HYPOTRACK_VIEW_PIXELS_INL_HPP_
#endif

#include "hypotrack/plugin/simd-inl.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

/// Walks over a hypothesis in one view, one vector of pixels at a time. An objective supplies its
/// features (PixelPlane, made in `prepare`) and a functor, as in stereo_pixels-inl.hpp:
///
///   struct MyTerm {
///     static constexpr bool kVisitsUncovered = false;  // not called where nothing is covered
///     const PixelPlane<float>& feature;
///     LaneSum sum;
///     HYPOTRACK_PIXEL void pixels(const ViewPixels& p) { sum.add(p.covered, p.here(feature)); }
///     HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
///   };
///   MyTerm term{...};
///   for_each_view_pixel(tile, covered_box(tile), term);
HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {

/// kLanes neighbouring pixels of a row of one view.
struct ViewPixels {
  int x, y;             ///< of the first lane; lane i is at x + i
  int pixels;           ///< number of lanes inside the walk's region; they come first
  Lanes inverse_depth;  ///< 1/m; 0 where uncovered
  // Each lane inside the region is in one of these masks; lanes outside it are in none.
  LaneMask covered, uncovered;

  /// Returns a feature; arbitrary outside the region. The plane has the tile's size.
  HYPOTRACK_PIXEL Lanes here(const PixelPlane<float>& plane) const {
    return load(plane.row(y) + x);
  }
  HYPOTRACK_PIXEL WordLanes here(const PixelPlane<std::uint32_t>& plane) const {
    return load(plane.row(y) + x);
  }
};

namespace detail {
// Returns kLanes values of a row from x on, 0 outside the region. Never reads beyond the stride.
HYPOTRACK_PIXEL Lanes load_depth(const float* row, int x, int pixels, int stride) {
  if (HWY_LIKELY(x + kLanes <= stride)) {
    return select(first_lanes(pixels), load(row + x), Lanes(0.0f));
  }
  HWY_ALIGN float copy[kLanes] = {};
  for (int i = 0; i < pixels; ++i) copy[i] = row[x + i];
  return load(copy);
}
}  // namespace detail

/// Calls functor.pixels() for the pixels of `region` of a tile, as shown above.
template <class Functor>
HYPOTRACK_PIXEL void for_each_view_pixel(const DepthTile& tile, const PixelBox& region,
                                         Functor& functor) {
  for (int y = region.y0; y < region.y1; ++y) {
    const float* row = tile.inverse_depth + static_cast<std::ptrdiff_t>(y) * tile.stride;
    for (int x = region.x0; x < region.x1; x += kLanes) {
      const int pixels = region.x1 - x < kLanes ? region.x1 - x : kLanes;
      const Lanes w = detail::load_depth(row, x, pixels, tile.stride);
      const LaneMask covered = w > Lanes(0.0f);
      if (!Functor::kVisitsUncovered && !any(covered)) continue;
      functor.pixels(ViewPixels{x, y, pixels, w, covered, first_lanes(pixels) && !covered});
    }
    functor.end_row();
  }
}

}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
