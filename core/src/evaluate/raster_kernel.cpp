// Triangles to inverse depth. Compiled once for every instruction set: the include below includes
// this file again.
//
// Hypotheses are drawn with a few thousand triangles of a few pixels each, so the work per triangle
// counts more than the work per pixel. First all triangles are culled, as many at a time as a
// vector has lanes; then the small ones are drawn with one triangle per lane, stepping all lanes
// through the pixels of their bounding boxes together, and the rest one by one with one pixel per
// lane.

#define HWY_TARGET_INCLUDE "evaluate/raster_kernel.cpp"
#include <hypotrack/foreach_target-inl.hpp>

#include "evaluate/block_vectors-inl.hpp"
#include "evaluate/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
constexpr I s32;
constexpr U u32;

// Triangles with less area (twice, pixels^2) are noise of single precision.
constexpr float kSmallestArea = 1e-6f;
// Edges are inclusive by this share of a triangle's height, so that no pixel falls between two
// triangles.
constexpr float kInclusive = 1e-5f;

// The same corner of kLanes triangles: x, y, 1/z, and x in the second view.
struct Corner {
  Vec x, y, w, x2;
};

// Where the record of corner `k` of the i-th triangle at hand lies.
struct InSequence {
  const std::uint32_t* corners;  // of the first
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

// Records of the triangles first, first + 4, first + 8 ..., one per 128-bit block.
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

// Pixels whose centres lie within the bounding boxes, inclusive, cut to the tile.
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

// Sorts the triangles that are `seen` and whose boxes reach `extent` pixels from their first by
// size.
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
  // Counted in local variables: stores into the lists could otherwise change the counts.
  VisibleTriangles lists[2] = {visible[0], pair ? visible[1] : VisibleTriangles{}};
  for (std::uint32_t t = range.begin; t < range.end; t += kLanes) {
    const auto [a, b, c] = load_corners(records, InSequence{corners + 4 * std::size_t{t}});
    const auto numbers = hn::Iota(u32, t);
    // The views of a rectified pair have the same rows but not the same columns.
    const Vec y0 = first_pixel(a.y, b.y, c.y);
    const Vec high_y = hn::Max(hn::Max(a.y, b.y), c.y);
    const Vec last_y = hn::Set(f, static_cast<float>(views[0].height - 1));
    const Vec y1 = hn::Floor(hn::Min(high_y, last_y));
    const Mask whole_y = hn::Le(high_y, last_y);
    const Mask in_rows =
        hn::And(hn::Le(y0, y1), hn::Gt(hn::Min(hn::Min(a.w, b.w), c.w), hn::Zero(f)));
    const auto view = [&](Vec ax, Vec bx, Vec cx, int width, VisibleTriangles& list) HWY_ATTR {
      // Counter-clockwise from outside is negative with y downwards.
      Vec area = hn::Neg(twice_area(ax, a.y, bx, b.y, cx, c.y));
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

// What drawing needs of kLanes triangles: their boxes, and the barycentric coordinates of corners a
// and b as planes over the pixels, from the first pixel of the box.
struct Planes {
  Vec x0, y0, x1, y1;
  Vec a, a_dx, a_dy, b, b_dx, b_dy;
  Vec w_c, w_ac, w_bc;  // 1/z = w_c + a w_ac + b w_bc: linear on the screen
};

HWY_INLINE Planes make_planes(const Corners& corners, bool second, const ViewProjection& view) {
  const auto& [a, b, c] = corners;
  Vec ax = second ? a.x2 : a.x, bx = second ? b.x2 : b.x, cx = second ? c.x2 : c.x;
  Planes p;
  p.x0 = first_pixel(ax, bx, cx);
  p.x1 = last_pixel(ax, bx, cx, view.width);
  p.y0 = first_pixel(a.y, b.y, c.y);
  p.y1 = last_pixel(a.y, b.y, c.y, view.height);
  // Coordinates from the first pixel are small, so that their products are exact enough.
  ax = hn::Sub(ax, p.x0), bx = hn::Sub(bx, p.x0), cx = hn::Sub(cx, p.x0);
  const Vec ay = hn::Sub(a.y, p.y0), by = hn::Sub(b.y, p.y0), cy = hn::Sub(c.y, p.y0);
  const Vec inverse_area = hn::Div(hn::Set(f, 1.0f), twice_area(ax, ay, bx, by, cx, cy));
  p.a = hn::Mul(hn::MulSub(bx, cy, hn::Mul(cx, by)), inverse_area);
  p.a_dx = hn::Mul(hn::Sub(by, cy), inverse_area);
  p.a_dy = hn::Mul(hn::Sub(cx, bx), inverse_area);
  p.b = hn::Mul(hn::MulSub(cx, ay, hn::Mul(ax, cy)), inverse_area);
  p.b_dx = hn::Mul(hn::Sub(cy, ay), inverse_area);
  p.b_dy = hn::Mul(hn::Sub(ax, cx), inverse_area);
  p.w_c = c.w;
  p.w_ac = hn::Sub(a.w, c.w);
  p.w_bc = hn::Sub(b.w, c.w);
  return p;
}

// Covered pixels that wait to be written: several triangles of a vector may cover the same one.
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

// Draws kLanes triangles that fit into kSize x kSize pixels: every lane steps through the pixels of
// such a square.
template <int kSize>
HWY_INLINE void draw_boxes(const Planes& p, int stride, Fragments& fragments) {
  const Vec c_dx = hn::Neg(hn::Add(p.a_dx, p.b_dx));
  auto row_origin =
      hn::Add(hn::Mul(hn::ConvertTo(s32, p.y0), hn::Set(s32, stride)), hn::ConvertTo(s32, p.x0));
  Vec row_a = p.a, row_b = p.b;
  std::size_t count = fragments.count;
  for (int dy = 0; dy < kSize; ++dy) {
    Vec a = row_a, b = row_b, c = hn::Sub(hn::Sub(hn::Set(f, 1.0f), row_a), row_b);
#pragma GCC unroll 8
    for (int dx = 0; dx < kSize; ++dx) {
      const Mask covered = hn::Ge(hn::Min(hn::Min(a, b), c), hn::Set(f, -kInclusive));
      const Vec w = hn::MulAdd(a, p.w_ac, hn::MulAdd(b, p.w_bc, p.w_c));
      const auto at = hn::Add(row_origin, hn::Set(s32, dx));
      hn::StoreU(hn::Compress(w, covered), f, fragments.inverse_depth + count);
      hn::StoreU(hn::Compress(at, hn::RebindMask(s32, covered)), s32, fragments.pixel + count);
      count += hn::CountTrue(f, covered);
      a = hn::Add(a, p.a_dx), b = hn::Add(b, p.b_dx), c = hn::Add(c, c_dx);
    }
    row_a = hn::Add(row_a, p.a_dy), row_b = hn::Add(row_b, p.b_dy);
    row_origin = hn::Add(row_origin, hn::Set(s32, stride));
  }
  fragments.count = count;
}

// One triangle of Planes in plain numbers.
struct Plane {
  alignas(64) float x0[kLanes], y0[kLanes], x1[kLanes], y1[kLanes];
  alignas(64) float a[kLanes], a_dx[kLanes], a_dy[kLanes], b[kLanes], b_dx[kLanes], b_dy[kLanes];
  alignas(64) float w_c[kLanes], w_ac[kLanes], w_bc[kLanes];
};

HWY_INLINE void store(const Planes& p, Plane& out) {
  hn::Store(p.x0, f, out.x0), hn::Store(p.y0, f, out.y0);
  hn::Store(p.x1, f, out.x1), hn::Store(p.y1, f, out.y1);
  hn::Store(p.a, f, out.a), hn::Store(p.a_dx, f, out.a_dx), hn::Store(p.a_dy, f, out.a_dy);
  hn::Store(p.b, f, out.b), hn::Store(p.b_dx, f, out.b_dx), hn::Store(p.b_dy, f, out.b_dy);
  hn::Store(p.w_c, f, out.w_c), hn::Store(p.w_ac, f, out.w_ac), hn::Store(p.w_bc, f, out.w_bc);
}

// Draws one triangle of any size, kLanes pixels of a row at a time, at multiples of kLanes: equal
// addresses and widths let the processor forward what it has just stored.
HWY_INLINE void draw_large(const Plane& p, std::size_t i, int stride, float* tile) {
  constexpr int kStep = static_cast<int>(kLanes);
  const int x0 = static_cast<int>(p.x0[i]), x1 = static_cast<int>(p.x1[i]);
  const int y0 = static_cast<int>(p.y0[i]), y1 = static_cast<int>(p.y1[i]);
  const int start = x0 - x0 % kStep;
  const Vec a_dx = hn::Set(f, p.a_dx[i]), b_dx = hn::Set(f, p.b_dx[i]);
  const Vec w_c = hn::Set(f, p.w_c[i]), w_ac = hn::Set(f, p.w_ac[i]), w_bc = hn::Set(f, p.w_bc[i]);
  const Vec last = hn::Set(f, static_cast<float>(x1 - x0));
  const Vec lanes = hn::Iota(f, static_cast<float>(start - x0));
  for (int y = y0; y <= y1; ++y) {
    const auto dy = static_cast<float>(y - y0);
    const Vec row_a = hn::Set(f, p.a[i] + dy * p.a_dy[i]);
    const Vec row_b = hn::Set(f, p.b[i] + dy * p.b_dy[i]);
    float* row = tile + static_cast<std::ptrdiff_t>(y) * stride;
    Vec dx = lanes;
    for (int x = start; x <= x1; x += kStep) {
      const Vec a = hn::MulAdd(dx, a_dx, row_a), b = hn::MulAdd(dx, b_dx, row_b);
      const Vec c = hn::Sub(hn::Sub(hn::Set(f, 1.0f), a), b);
      const Mask inside = hn::Ge(hn::Min(hn::Min(a, b), c), hn::Set(f, -kInclusive));
      const Mask covered = hn::And(inside, hn::Le(dx, last));
      const Vec w = hn::MulAdd(a, w_ac, hn::MulAdd(b, w_bc, w_c));
      const Vec nearest = hn::Load(f, row + x);
      hn::Store(hn::Max(nearest, hn::IfThenElseZero(covered, w)), f, row + x);
      dx = hn::Add(dx, hn::Set(f, static_cast<float>(kStep)));
    }
  }
}

// What is being drawn into one tile.
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

// Whole vectors: what lies beside the pixels to be cleared is zero already.
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
namespace hypotrack {
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

}  // namespace hypotrack
#endif
