// Rasterises triangles to inverse depth. Compiled once per instruction set: the include below
// includes this file again.
//
// Hypotheses have a few thousand triangles of a few pixels each, so the work per triangle
// dominates. First all triangles are culled, one per lane. Small triangles are then drawn one per
// lane; all lanes step through the pixels of their bounding boxes together. The rest are drawn one
// by one, with one pixel per lane.

#define HWY_TARGET_INCLUDE "cost/draw/raster_kernel.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "cost/draw/raster_kernels.hpp"
#include "scene/block_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
constexpr I s32;
constexpr U u32;

// Smallest drawn area (twice, pixels^2); below it, single precision gives only noise.
constexpr float kSmallestArea = 1e-6f;
// Widening of the edges, as a share of a triangle's height, so that no pixel falls between two
// triangles.
constexpr float kInclusive = 1e-5f;
// Slope (barycentric coordinate per pixel) below which an edge counts as horizontal.
constexpr float kHorizontal = 1e-20f;

// One corner of kLanes triangles: x, y, 1/z, and x in the second view.
struct Corner {
  Vec x, y, w, x2;
};

// Returns the offset of the record of corner `k` of triangle i.
struct InSequence {
  const std::uint32_t* corners;  // of triangle 0
  HWY_INLINE std::size_t operator()(std::size_t i, std::size_t k) const {
    return corners[4 * i + k];
  }
};
struct InList {
  const std::uint32_t* corners;
  const std::uint32_t* list;
  HWY_INLINE std::size_t operator()(std::size_t i, std::size_t k) const {
    return corners[4 * std::size_t{list[i]} + k];
  }
};

#if HWY_TARGET == HWY_SCALAR

template <class Offset>
HWY_INLINE Corner load_corner(const float* records, const Offset& offset, std::size_t k) {
  const float* record = records + offset(0, k);
  return {hn::Set(f, record[0]), hn::Set(f, record[1]), hn::Set(f, record[2]),
          hn::Set(f, record[3])};
}

#else

// Loads records first, first + 4, first + 8, ..., one per 128-bit block.
template <class D, class Offset>
HWY_INLINE hn::Vec<D> load_records(D d, const float* records, const Offset& offset,
                                   std::size_t first, std::size_t k) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::Load(d, records + offset(first, k));
  } else {
    const hn::Half<D> half;
    const auto low = load_records(half, records, offset, first, k);
    const auto high = load_records(half, records, offset, first + hn::MaxLanes(half), k);
    return hn::Combine(d, high, low);
  }
}

template <class Offset>
HWY_INLINE Corner load_corner(const float* records, const Offset& offset, std::size_t k) {
  const hn::RepartitionToWide<F> wide;
  const Vec r0 = load_records(f, records, offset, 0, k);
  const Vec r1 = load_records(f, records, offset, 1, k);
  const Vec r2 = load_records(f, records, offset, 2, k);
  const Vec r3 = load_records(f, records, offset, 3, k);
  // Transpose the 4x4 numbers of every block.
  const auto xy01 = hn::BitCast(wide, hn::InterleaveLower(f, r0, r1));
  const auto xy23 = hn::BitCast(wide, hn::InterleaveLower(f, r2, r3));
  const auto wx01 = hn::BitCast(wide, hn::InterleaveUpper(f, r0, r1));
  const auto wx23 = hn::BitCast(wide, hn::InterleaveUpper(f, r2, r3));
  return {hn::BitCast(f, hn::InterleaveLower(wide, xy01, xy23)),
          hn::BitCast(f, hn::InterleaveUpper(wide, xy01, xy23)),
          hn::BitCast(f, hn::InterleaveLower(wide, wx01, wx23)),
          hn::BitCast(f, hn::InterleaveUpper(wide, wx01, wx23))};
}

#endif  // HWY_TARGET == HWY_SCALAR

struct Corners {
  Corner a, b, c;
};

template <class Offset>
HWY_INLINE Corners load_corners(const float* records, const Offset& offset) {
  return {load_corner(records, offset, 0), load_corner(records, offset, 1),
          load_corner(records, offset, 2)};
}

// Computes the pixels whose centres lie within the bounding boxes, inclusive, clamped to the tile.
struct Boxes {
  Vec x0, y0, x1, y1;
};

HWY_INLINE Vec first_pixel(Vec a, Vec b, Vec c) {
  return hn::Ceil(hn::Max(hn::Min(hn::Min(a, b), c), hn::Zero(f)));
}

HWY_INLINE Vec last_pixel(Vec a, Vec b, Vec c, int size) {
  const Vec limit = hn::Set(f, static_cast<float>(size - 1));
  return hn::Floor(hn::Min(hn::Max(hn::Max(a, b), c), limit));
}

HWY_INLINE Vec twice_area(Vec ax, Vec ay, Vec bx, Vec by, Vec cx, Vec cy) {
  return hn::MulSub(hn::Sub(bx, ax), hn::Sub(cy, ay), hn::Mul(hn::Sub(cx, ax), hn::Sub(by, ay)));
}

HWY_INLINE void append(hn::Vec<U> numbers, Mask mask, std::uint32_t* list, std::size_t& count) {
  const auto bits = hn::RebindMask(u32, mask);
  hn::StoreU(hn::Compress(numbers, bits), u32, list + count);
  count += hn::CountTrue(u32, bits);
}

// Appends the `seen` triangles to the lists by size; `extent` is their box's size minus one.
HWY_INLINE void append_by_size(hn::Vec<U> numbers, Mask seen, Mask whole, Vec extent,
                               VisibleTriangles& visible) {
  Mask left = seen;
  for (int i = 0; i + 1 < kSizeClasses; ++i) {
    const Vec limit = hn::Set(f, static_cast<float>(kBoxSizes[i] - 1));
    const Mask fits = hn::And(whole, hn::Le(extent, limit));
    append(numbers, hn::And(left, fits), visible.list[i], visible.count[i]);
    left = hn::AndNot(fits, left);
  }
  append(numbers, left, visible.list[kSizeClasses - 1], visible.count[kSizeClasses - 1]);
}

void cull(const std::uint32_t* corners, const TriangleRange& range, const float* records,
          const ViewProjection* views, bool pair, VisibleTriangles* visible) {
  const Vec smallest = hn::Set(f, kSmallestArea);
  // Count in local variables, because stores into the lists might alias the counts.
  VisibleTriangles lists[2] = {visible[0], pair ? visible[1] : VisibleTriangles{}};
  for (std::uint32_t t = range.begin; t < range.end; t += kLanes) {
    const auto [a, b, c] = load_corners(records, InSequence{corners + 4 * std::size_t{t}});
    const auto numbers = hn::Iota(u32, t);
    // The views of a rectified pair have the same rows but not the same columns.
    const Vec ay = a.y, by = b.y, cy = c.y;  // Clang's lambdas take no structured bindings
    const Vec y0 = first_pixel(ay, by, cy);
    const Vec high_y = hn::Max(hn::Max(ay, by), cy);
    const Vec last_y = hn::Set(f, static_cast<float>(views[0].height - 1));
    const Vec y1 = hn::Floor(hn::Min(high_y, last_y));
    const Mask whole_y = hn::Le(high_y, last_y);
    const Mask in_rows =
        hn::And(hn::Le(y0, y1), hn::Gt(hn::Min(hn::Min(a.w, b.w), c.w), hn::Zero(f)));
    const auto view = [&](Vec ax, Vec bx, Vec cx, int width, VisibleTriangles& list) HWY_ATTR {
      // The area is negative if counter-clockwise from outside (y is down).
      Vec area = hn::Neg(twice_area(ax, ay, bx, by, cx, cy));
      if (range.two_sided) area = hn::Abs(area);
      const Vec x0 = first_pixel(ax, bx, cx);
      const Vec high_x = hn::Max(hn::Max(ax, bx), cx);
      const Vec last_x = hn::Set(f, static_cast<float>(width - 1));
      const Vec x1 = hn::Floor(hn::Min(high_x, last_x));
      const Mask seen = hn::And(hn::And(in_rows, hn::Le(x0, x1)), hn::Gt(area, smallest));
      const Mask whole = hn::And(whole_y, hn::Le(high_x, last_x));
      append_by_size(numbers, seen, whole, hn::Max(hn::Sub(x1, x0), hn::Sub(y1, y0)), list);
    };
    view(a.x, b.x, c.x, views[0].width, lists[0]);
    if (pair) view(a.x2, b.x2, c.x2, views[1].width, lists[1]);
  }
  visible[0] = lists[0];
  if (pair) visible[1] = lists[1];
}

// Intersection of an edge of kLanes triangles with the rows: x = at + dy * per_row, in pixels from
// the box's first. `right` tells on which side the triangle lies.
struct Crossing {
  Vec at, per_row;
  Mask right;

  // Clips the columns first .. last to the inner side of the edge; `first` is not negative.
  HWY_INLINE void cut(Vec dy, Vec& first, Vec& last) const {
    const Vec x = hn::MulAdd(dy, per_row, at);
    first = hn::Max(first, hn::IfThenElseZero(right, x));
    last = hn::IfThenElse(right, last, hn::Min(last, x));
  }
};

// Returns the crossing of the edge a + dx * a_dx + dy * a_dy = 0, slightly widened.
HWY_INLINE Crossing crossing(Vec a, Vec a_dx, Vec a_dy) {
  const Vec horizontal = hn::Set(f, kHorizontal);
  const Vec slope = hn::IfThenElse(hn::Lt(hn::Abs(a_dx), horizontal), horizontal, a_dx);
  const Vec inverse = hn::Neg(hn::Div(hn::Set(f, 1.0f), slope));
  return {hn::Mul(hn::Add(a, hn::Set(f, kInclusive)), inverse), hn::Mul(a_dy, inverse),
          hn::Gt(slope, hn::Zero(f))};
}

// Drawing parameters of kLanes triangles: their boxes, edge crossings, and 1/z as a plane over the
// pixels, relative to the box's first.
struct Planes {
  Vec x0, y0, x1, y1;
  Crossing a, b, c;  // opposite to the corners
  Vec w, w_dx, w_dy;
};

HWY_INLINE Planes make_planes(const Corners& corners, bool second, const ViewProjection& view) {
  const auto& [a, b, c] = corners;
  Vec ax = second ? a.x2 : a.x, bx = second ? b.x2 : b.x, cx = second ? c.x2 : c.x;
  Planes p;
  p.x0 = first_pixel(ax, bx, cx);
  p.x1 = last_pixel(ax, bx, cx, view.width);
  p.y0 = first_pixel(a.y, b.y, c.y);
  p.y1 = last_pixel(a.y, b.y, c.y, view.height);
  // Coordinates relative to the first pixel are small, so their products are accurate.
  ax = hn::Sub(ax, p.x0), bx = hn::Sub(bx, p.x0), cx = hn::Sub(cx, p.x0);
  const Vec ay = hn::Sub(a.y, p.y0), by = hn::Sub(b.y, p.y0), cy = hn::Sub(c.y, p.y0);
  const Vec area = twice_area(ax, ay, bx, by, cx, cy), one = hn::Set(f, 1.0f);
  const Vec inverse_area = hn::Div(one, area);
  // A triangle without area has no column.
  p.x1 = hn::IfThenElse(hn::Eq(area, hn::Zero(f)), hn::Sub(p.x0, one), p.x1);
  // Barycentric coordinates of corners a and b as planes.
  const Vec at_a = hn::Mul(hn::MulSub(bx, cy, hn::Mul(cx, by)), inverse_area);
  const Vec a_dx = hn::Mul(hn::Sub(by, cy), inverse_area);
  const Vec a_dy = hn::Mul(hn::Sub(cx, bx), inverse_area);
  const Vec at_b = hn::Mul(hn::MulSub(cx, ay, hn::Mul(ax, cy)), inverse_area);
  const Vec b_dx = hn::Mul(hn::Sub(cy, ay), inverse_area);
  const Vec b_dy = hn::Mul(hn::Sub(ax, cx), inverse_area);
  p.a = crossing(at_a, a_dx, a_dy);
  p.b = crossing(at_b, b_dx, b_dy);
  p.c = crossing(hn::Sub(hn::Sub(one, at_a), at_b), hn::Neg(hn::Add(a_dx, b_dx)),
                 hn::Neg(hn::Add(a_dy, b_dy)));
  const Vec w_ac = hn::Sub(a.w, c.w), w_bc = hn::Sub(b.w, c.w);
  p.w = hn::MulAdd(at_a, w_ac, hn::MulAdd(at_b, w_bc, c.w));
  p.w_dx = hn::MulAdd(a_dx, w_ac, hn::Mul(b_dx, w_bc));
  p.w_dy = hn::MulAdd(a_dy, w_ac, hn::Mul(b_dy, w_bc));
  return p;
}

// Returns the columns of row y0 + dy that triangles cover, relative to x0: first <= dx <= last.
struct Columns {
  Vec first, last;
};

HWY_INLINE Columns columns_of_row(const Crossing& a, const Crossing& b, const Crossing& c, Vec dy,
                                  Vec last_column) {
  Columns columns{hn::Zero(f), last_column};
  a.cut(dy, columns.first, columns.last);
  b.cut(dy, columns.first, columns.last);
  c.cut(dy, columns.first, columns.last);
  return columns;
}

// Covered pixels waiting to be written, because several triangles of a vector may cover one pixel.
struct Fragments {
  static constexpr std::size_t kRoom = 4096;
  static constexpr std::size_t kMost =
      kLanes * kBoxSizes[kSizeClasses - 2] * kBoxSizes[kSizeClasses - 2];
  alignas(64) float inverse_depth[kRoom + kMost + kLanes];
  alignas(64) std::int32_t pixel[kRoom + kMost + kLanes];
  std::size_t count;
};

HWY_INLINE void flush(Fragments& fragments, float* tile) {
  for (std::size_t i = 0; i < fragments.count; ++i) {
    float& nearest = tile[fragments.pixel[i]];
    nearest = fragments.inverse_depth[i] > nearest ? fragments.inverse_depth[i] : nearest;
  }
  fragments.count = 0;
}

// Draws kLanes triangles that fit into kSize x kSize pixels; all lanes step through that square.
template <int kSize>
HWY_INLINE void draw_boxes(const Planes& p, int stride, Fragments& fragments) {
  auto row_origin =
      hn::Add(hn::Mul(hn::ConvertTo(s32, p.y0), hn::Set(s32, stride)), hn::ConvertTo(s32, p.x0));
  const Vec last_row = hn::Sub(p.y1, p.y0), last_column = hn::Sub(p.x1, p.x0);
  std::size_t count = fragments.count;
  for (int y = 0; y < kSize; ++y) {
    const Vec dy = hn::Set(f, static_cast<float>(y));
    const Mask is_row = hn::Le(dy, last_row);
    const Columns columns = columns_of_row(p.a, p.b, p.c, dy, last_column);
    const Vec last = hn::IfThenElse(is_row, columns.last, hn::Set(f, -1.0f));
    const Vec row_w = hn::MulAdd(dy, p.w_dy, p.w);
#pragma GCC unroll 8
    for (int x = 0; x < kSize; ++x) {
      const Vec dx = hn::Set(f, static_cast<float>(x));
      const Mask covered = hn::And(hn::Le(columns.first, dx), hn::Le(dx, last));
      const Vec w = hn::MulAdd(dx, p.w_dx, row_w);
      const auto at = hn::Add(row_origin, hn::Set(s32, x));
      hn::StoreU(hn::Compress(w, covered), f, fragments.inverse_depth + count);
      hn::StoreU(hn::Compress(at, hn::RebindMask(s32, covered)), s32, fragments.pixel + count);
      count += hn::CountTrue(f, covered);
    }
    row_origin = hn::Add(row_origin, hn::Set(s32, stride));
  }
  fragments.count = count;
}

// Planes stored as plain floats, to be read one triangle at a time.
struct Plane {
  struct Edge {
    alignas(64) float at[kLanes], per_row[kLanes], right[kLanes];
    HWY_INLINE void set(const Crossing& from) {
      hn::Store(from.at, f, at), hn::Store(from.per_row, f, per_row);
      hn::Store(hn::IfThenElseZero(from.right, hn::Set(f, 1.0f)), f, right);
    }
    HWY_INLINE Crossing get(std::size_t i) const {
      return {hn::Set(f, at[i]), hn::Set(f, per_row[i]), hn::Gt(hn::Set(f, right[i]), hn::Zero(f))};
    }
  };
  alignas(64) float x0[kLanes], y0[kLanes], x1[kLanes], y1[kLanes];
  Edge a, b, c;
  alignas(64) float w[kLanes], w_dx[kLanes], w_dy[kLanes];
};

HWY_INLINE void store(const Planes& p, Plane& out) {
  hn::Store(p.x0, f, out.x0), hn::Store(p.y0, f, out.y0);
  hn::Store(p.x1, f, out.x1), hn::Store(p.y1, f, out.y1);
  out.a.set(p.a), out.b.set(p.b), out.c.set(p.c);
  hn::Store(p.w, f, out.w), hn::Store(p.w_dx, f, out.w_dx), hn::Store(p.w_dy, f, out.w_dy);
}

// Draws one triangle of any size, kLanes pixels of a row at a time, aligned to kLanes. With equal
// addresses and widths the processor can forward recent stores.
HWY_INLINE void draw_large(const Plane& p, std::size_t i, int stride, float* tile) {
  constexpr int kStep = static_cast<int>(kLanes);
  const int x0 = static_cast<int>(p.x0[i]), x1 = static_cast<int>(p.x1[i]);
  const int y0 = static_cast<int>(p.y0[i]), y1 = static_cast<int>(p.y1[i]);
  const Crossing a = p.a.get(i), b = p.b.get(i), c = p.c.get(i);
  const Vec w_dx = hn::Set(f, p.w_dx[i]), w_dy = hn::Set(f, p.w_dy[i]), at_w = hn::Set(f, p.w[i]);
  const Vec last_column = hn::Set(f, static_cast<float>(x1 - x0));
  for (int y = y0; y <= y1; ++y) {
    const Vec dy = hn::Set(f, static_cast<float>(y - y0));
    const Columns columns = columns_of_row(a, b, c, dy, last_column);
    const float first = hn::GetLane(columns.first), last = hn::GetLane(columns.last);
    if (!(first <= last)) continue;  // so that both lie within the box
    const int begin = x0 + static_cast<int>(first), end = x0 + static_cast<int>(last);
    const Vec row_w = hn::MulAdd(dy, w_dy, at_w);
    float* row = tile + static_cast<std::ptrdiff_t>(y) * stride;
    const int start = begin - begin % kStep;
    Vec dx = hn::Iota(f, static_cast<float>(start - x0));
    for (int x = start; x <= end; x += kStep) {
      const Mask covered = hn::And(hn::Le(columns.first, dx), hn::Le(dx, columns.last));
      const Vec w = hn::MulAdd(dx, w_dx, row_w);
      const Vec nearest = hn::Load(f, row + x);
      hn::Store(hn::Max(nearest, hn::IfThenElseZero(covered, w)), f, row + x);
      dx = hn::Add(dx, hn::Set(f, static_cast<float>(kStep)));
    }
  }
}

// The tile being drawn.
struct Drawing {
  const std::uint32_t* corners;
  const float* records;
  bool second;
  const ViewProjection& view;
  float* tile;

  HWY_INLINE Planes planes(const std::uint32_t* list) const {
    return make_planes(load_corners(records, InList{corners, list}), second, view);
  }
};

template <int kSize>
void draw_small(const Drawing& drawing, const std::uint32_t* list, std::size_t count,
                Fragments& fragments) {
  for (std::size_t t = 0; t < count; t += kLanes) {
    draw_boxes<kSize>(drawing.planes(list + t), drawing.view.stride, fragments);
    if (fragments.count > Fragments::kRoom) flush(fragments, drawing.tile);
  }
}

void draw(const std::uint32_t* corners, std::uint32_t degenerate, const float* records, bool second,
          const ViewProjection& view, VisibleTriangles& visible, float* tile) {
  for (int i = 0; i < kSizeClasses; ++i) {
    std::uint32_t* end = visible.list[i] + visible.count[i];
    for (std::size_t k = 0; k < kLanes; ++k) end[k] = degenerate;
  }
  const Drawing drawing{corners, records, second, view, tile};
  Fragments fragments;
  fragments.count = 0;
  draw_small<kBoxSizes[0]>(drawing, visible.list[0], visible.count[0], fragments);
  draw_small<kBoxSizes[1]>(drawing, visible.list[1], visible.count[1], fragments);
  draw_small<kBoxSizes[2]>(drawing, visible.list[2], visible.count[2], fragments);
  draw_small<kBoxSizes[3]>(drawing, visible.list[3], visible.count[3], fragments);
  flush(fragments, tile);
  constexpr int kLast = kSizeClasses - 1;
  for (std::size_t t = 0; t < visible.count[kLast]; t += kLanes) {
    Plane plane;
    store(drawing.planes(visible.list[kLast] + t), plane);
    const std::size_t count = HWY_MIN(kLanes, visible.count[kLast] - t);
    for (std::size_t i = 0; i < count; ++i) draw_large(plane, i, view.stride, tile);
  }
}

// Clears whole vectors; the pixels beside the box are already zero.
void clear(float* tile, int stride, int x0, int y0, int x1, int y1) {
  constexpr int kStep = static_cast<int>(kLanes);
  for (int y = y0; y < y1; ++y) {
    float* row = tile + static_cast<std::ptrdiff_t>(y) * stride;
    for (int x = x0 - x0 % kStep; x < x1; x += kStep) hn::Store(hn::Zero(f), f, row + x);
  }
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {
HWY_EXPORT(cull);
HWY_EXPORT(draw);
HWY_EXPORT(clear);
}  // namespace

void cull_triangles(const std::uint32_t* corners, const TriangleRange& range, const float* records,
                    const ViewProjection* views, bool pair, VisibleTriangles* visible) {
  HWY_DYNAMIC_DISPATCH(cull)(corners, range, records, views, pair, visible);
}

void draw_triangles(const std::uint32_t* corners, std::uint32_t degenerate, const float* records,
                    bool second, const ViewProjection& view, VisibleTriangles& visible,
                    float* tile) {
  HWY_DYNAMIC_DISPATCH(draw)(corners, degenerate, records, second, view, visible, tile);
}

void clear_pixels(float* tile, int stride, int x0, int y0, int x1, int y1) {
  HWY_DYNAMIC_DISPATCH(clear)(tile, stride, x0, y0, x1, y1);
}

}  // namespace hypotrack::internal
#endif
