// Included once per instruction set: no #pragma once.
#if defined(HYPOTRACK_STEREO_PIXELS_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef HYPOTRACK_STEREO_PIXELS_INL_HPP_
#undef HYPOTRACK_STEREO_PIXELS_INL_HPP_
#else
#define HYPOTRACK_STEREO_PIXELS_INL_HPP_
#endif

#include "hypotrack/plugin/simd-inl.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"
#include "hypotrack/plugin/view_pixels-inl.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

/// Walks over a stereo hypothesis, one vector of pixels at a time. An objective supplies its
/// features (PixelPlane, made in `prepare`) and a functor:
///
///   struct MyTerm {
///     static constexpr bool kVisitsUncovered = false;  // not called where nothing is covered
///     const PixelPlane<float>& left_feature;
///     const PixelPlane<float>& right_feature;
///     LaneSum sum;
///     HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
///       const Lanes here = p.here(left_feature), there = p.nearest(right_feature);
///       sum.add(p.seen, closeness(here, there));       // a per-pixel function (pixel.hpp)
///     }
///     HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
///   };
///   MyTerm term{...};
///   for_each_stereo_pixel(left, right, map, 0.003f, covered_box(left), term);
///
/// Pixels outside the covered box are uncovered. A term that needs them can walk whole_tile(left)
/// with kVisitsUncovered. It is cheaper to sum the cost of "uncovered" over the whole tile in
/// `prepare` and subtract that of the covered pixels here.
HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {

namespace detail {
template <class T>
struct LanesOf {
  using type = Lanes;
};
template <>
struct LanesOf<std::uint32_t> {
  using type = WordLanes;
};

// Selects row[window + offset] for 0 <= offset < 2 * kLanes from two registers.
template <class Tag>
HYPOTRACK_PIXEL hn::Vec<Tag> pick(Tag tag, const hn::TFromD<Tag>* row, int window,
                                  hn::Vec<IntTag> offset) {
  const auto lane = hn::And(offset, hn::Set(IntTag(), kLanes - 1));
  const auto index = hn::IndicesFromVec(tag, lane);
  const auto low = hn::TableLookupLanes(hn::LoadU(tag, row + window), index);
  const auto high = hn::TableLookupLanes(hn::LoadU(tag, row + window + kLanes), index);
  const auto is_low = hn::Lt(offset, hn::Set(IntTag(), kLanes));
  return hn::IfThenElse(hn::RebindMask(tag, is_low), low, high);
}

// Returns row[column] of active lanes. Neighbours map near each other: nearly always all columns
// lie within two vectors from `window` on. Two loads and permutations are several times faster than
// a gather. A negative window always gathers.
template <class T>
HYPOTRACK_PIXEL typename LanesOf<T>::type look_up(const T* row, IntLanes column, LaneMask active,
                                                  int window) {
  if constexpr (kLanes >= 8) {
    const auto offset = hn::Sub(column.v, hn::Set(IntTag(), window));
    // A bit above those of 2 * kLanes - 1 marks an offset that is too large or negative.
    const auto far = hn::Ne(hn::And(offset, hn::Set(IntTag(), -2 * kLanes)), hn::Zero(IntTag()));
    const LaneMask outside = active && LaneMask{hn::RebindMask(FloatTag(), far)};
    if (HWY_LIKELY(window >= 0 && !any(outside))) {
      return typename LanesOf<T>::type{pick(hn::ScalableTag<T>(), row, window, offset)};
    }
  }
  const auto safe = hn::IfThenElseZero(hn::RebindMask(IntTag(), active.m), column.v);
  return gather(row, IntLanes{safe});
}
}  // namespace detail

/// Top-left corner and weights of a bilinear interpolation. A rectified pair needs two of the four
/// pixels.
struct BilinearLanes {
  IntLanes x0, y0;
  Lanes fx, fy;  ///< weight of the right and the lower neighbours
};

/// kLanes neighbouring pixels of a row of the reference view ("here") and their match in the other
/// view ("there").
struct StereoPixels {
  int x, y;             ///< of the first lane; lane i is at x + i
  int pixels;           ///< number of lanes inside the walk's region; they come first
  Lanes inverse_depth;  ///< here, 1/m; 0 where uncovered
  // Each lane inside the region is in exactly one of these masks; lanes outside it are in none.
  LaneMask seen, occluded, uncovered;
  Lanes u, v;            ///< position of the surface point there, pixels; arbitrary if not seen
  IntLanes column, row;  ///< nearest pixel to (u, v); 0 if outside the tile there
  int width, height;     ///< size of the tile there
  bool same_row;         ///< true for a rectified pair: row == y
  int window;            ///< internal: first column of look_up()'s two vectors

  /// Returns a feature here; arbitrary outside the region.
  HYPOTRACK_PIXEL Lanes here(const PixelPlane<float>& plane) const {
    return load(plane.row(y) + x);
  }
  HYPOTRACK_PIXEL WordLanes here(const PixelPlane<std::uint32_t>& plane) const {
    return load(plane.row(y) + x);
  }
  /// Returns a feature there, at the nearest pixel; arbitrary if not seen. The plane has the tile's
  /// size.
  template <class T>
  HYPOTRACK_PIXEL typename detail::LanesOf<T>::type nearest(const PixelPlane<T>& plane) const {
    return at(plane, column, row);
  }
  /// Returns a feature there, at one pixel of the tile per lane; arbitrary if not seen.
  template <class T>
  HYPOTRACK_PIXEL typename detail::LanesOf<T>::type at(const PixelPlane<T>& plane, IntLanes px,
                                                       IntLanes py) const {
    if (same_row) return detail::look_up(plane.row(y), px, seen, window);
    const IntLanes index = py * int_lanes(width) + px;
    return detail::look_up(plane.row(0), index, seen, -1);
  }
  /// Returns corners and weights for bilinear interpolation at (u, v), clamped to the tile. The
  /// tile has at least two rows and columns.
  HYPOTRACK_PIXEL BilinearLanes bilinear() const {
    const Lanes zero(0.0f), one(1.0f);
    const Lanes su = select(seen, u, zero), sv = select(seen, v, zero);
    const Lanes x0 = min(max(floor(su), zero), Lanes(static_cast<float>(width - 2)));
    const Lanes y0 = min(max(floor(sv), zero), Lanes(static_cast<float>(height - 2)));
    return {to_int(x0), to_int(y0), min(max(su - x0, zero), one), min(max(sv - y0, zero), one)};
  }
};

namespace detail {
// Returns look_up()'s window: two vectors around the position that lane `lane` maps to.
HYPOTRACK_PIXEL int window_for(const StereoMap& map, const float* row, int x, int lane) {
  if (map.width < 2 * kLanes) return -1;
  const float w = row[x + lane];
  const float shift = map.a[0][2] + map.b[0] * w;
  const int start = x + static_cast<int>(shift) - kLanes / 2;
  const int highest = map.width - 2 * kLanes;
  return start < 0 ? 0 : start > highest ? highest : start;
}

template <bool kRectified, class Functor>
HYPOTRACK_PIXEL void walk_vector(const DepthTile& here, const DepthTile& there,
                                 const StereoMap& map, float tolerance, int x, int y, int pixels,
                                 Functor& functor) {
  const float* depth_row = here.inverse_depth + static_cast<std::ptrdiff_t>(y) * here.stride;
  const Lanes w = load_depth(depth_row, x, pixels, here.stride);
  const LaneMask covered = w > Lanes(0.0f);
  if (!Functor::kVisitsUncovered && !any(covered)) return;

  StereoPixels p;
  p.x = x;
  p.y = y;
  p.pixels = pixels;
  p.inverse_depth = w;
  p.width = map.width;
  p.height = map.height;
  p.same_row = kRectified;
  p.uncovered = first_lanes(pixels) && !covered;
  const Mapped<Lanes> m = map_pixel<kRectified>(map, count_from(static_cast<float>(x)),
                                                Lanes(static_cast<float>(y)), w);
  p.u = m.u;
  p.v = m.v;
  const LaneMask within = covered && lands_inside<kRectified>(map, m);
  p.column = to_int(select(within, m.u, Lanes(0.0f)));
  p.row = kRectified ? int_lanes(y) : to_int(select(within, m.v, Lanes(0.0f)));
  p.window = -1;
  Lanes w_there;
  if constexpr (kRectified) {
    const int lane = first(within);
    if (kLanes >= 8 && lane >= 0) p.window = window_for(map, depth_row, x, lane);
    w_there = look_up(there.inverse_depth + static_cast<std::ptrdiff_t>(y) * there.stride, p.column,
                      within, p.window);
  } else {
    const IntLanes index = p.row * int_lanes(there.stride) + p.column;
    w_there = look_up(there.inverse_depth, index, within, -1);
  }
  p.seen = within && same_depth(m.inverse_depth, w_there, Lanes(tolerance));
  p.occluded = covered && !p.seen;
  functor.pixels(p);
}

template <bool kRectified, class Functor>
HYPOTRACK_PIXEL void walk(const DepthTile& here, const DepthTile& there, const StereoMap& map,
                          float tolerance, const PixelBox& region, Functor& functor) {
  for (int y = region.y0; y < region.y1; ++y) {
    for (int x = region.x0; x < region.x1; x += kLanes) {
      const int pixels = region.x1 - x < kLanes ? region.x1 - x : kLanes;
      walk_vector<kRectified>(here, there, map, tolerance, x, y, pixels, functor);
    }
    functor.end_row();
  }
}
}  // namespace detail

/// Calls functor.pixels() for the pixels of `region` of the reference tile `here`, as shown above.
/// `map` is stereo_map(observation, here, there). A surface point counts as seen if the depth
/// rendered there differs from its own by at most `tolerance` metres.
template <class Functor>
HYPOTRACK_PIXEL void for_each_stereo_pixel(const DepthTile& here, const DepthTile& there,
                                           const StereoMap& map, float tolerance,
                                           const PixelBox& region, Functor& functor) {
  if (map.rectified) {
    detail::walk<true>(here, there, map, tolerance, region, functor);
  } else {
    detail::walk<false>(here, there, map, tolerance, region, functor);
  }
}

}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
