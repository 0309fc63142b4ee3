// Triangles to inverse depth. Compiled once for every instruction set: the include below includes
// this file again.
//
// Hypotheses are drawn with a few thousand triangles of a few pixels each, so the work per triangle
// counts more than the work per pixel. First all triangles are culled, as many at a time as a
// vector has lanes; then the small ones are drawn with one triangle per lane, stepping all lanes
// through the pixels of their bounding boxes together, and the rest one by one with one pixel per
// lane.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "evaluate/raster_kernel.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "evaluate/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, kBlock>;
using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
using Vec = hn::Vec<F>;
using Mask = hn::Mask<F>;
constexpr F f;
constexpr I s32;
constexpr U u32;
constexpr std::size_t kLanes = hn::MaxLanes(F());

// Triangles with less area (twice, pixels^2) are noise of single precision.
constexpr float kSmallestArea = 1e-6f;
// Edges are inclusive by this share of a triangle's height, so that no pixel falls between two
// triangles.
constexpr float kInclusive = 1e-5f;

// The same corner of kLanes triangles: x, y, 1/z, and x in the second view.
struct Corner {
  Vec x, y, w, x2;
};

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE Corner load_corner(const float* records, const std::uint32_t* offsets) {
  const float* record = records + offsets[0];
  return {hn::Set(f, record[0]), hn::Set(f, record[1]), hn::Set(f, record[2]),
          hn::Set(f, record[3])};
}

#else

// One 16-byte record for every fourth of `offsets`, in 128-bit blocks.
template <class D>
HWY_INLINE hn::Vec<D> load_records(D d, const float* records, const std::uint32_t* offsets) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::Load(d, records + offsets[0]);
  } else {
    const hn::Half<D> half;
    const auto low = load_records(half, records, offsets);
    const auto high = load_records(half, records, offsets + hn::MaxLanes(half));
    return hn::Combine(d, high, low);
  }
}

HWY_INLINE Corner load_corner(const float* records, const std::uint32_t* offsets) {
  const hn::RepartitionToWide<F> wide;
  // Lane t of every 128-bit block b belongs to triangle 4 b + t: a 4x4 transposition per block.
  const Vec r0 = load_records(f, records, offsets), r1 = load_records(f, records, offsets + 1);
  const Vec r2 = load_records(f, records, offsets + 2), r3 = load_records(f, records, offsets + 3);
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

// `number(i)` is the i-th triangle.
template <class Number>
HWY_INLINE Corners load_corners(const std::uint32_t* corners, const float* records, Number number) {
  alignas(64) std::uint32_t offsets[3][kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::uint32_t* triangle = corners + 4 * std::size_t{number(i)};
    offsets[0][i] = triangle[0];
    offsets[1][i] = triangle[1];
    offsets[2][i] = triangle[2];
  }
  return {load_corner(records, offsets[0]), load_corner(records, offsets[1]),
          load_corner(records, offsets[2])};
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

void cull(const std::uint32_t* corners, const TriangleRange& range, const float* records,
          const ViewProjection* views, bool pair, VisibleTriangles* visible) {
  const Vec smallest = hn::Set(f, kSmallestArea);
  const Vec small = hn::Set(f, kSmall - 1.0f);
  // The views of a rectified pair have the same rows but not the same columns. Lists are kept in
  // local variables: stores through the list pointers could otherwise change them.
  VisibleTriangles lists[2] = {visible[0], pair ? visible[1] : VisibleTriangles{}};
  for (std::uint32_t t = range.begin; t < range.end; t += kLanes) {
    const auto [a, b, c] = load_corners(
        corners, records, [t](std::size_t i) { return t + static_cast<std::uint32_t>(i); });
    const auto numbers = hn::Iota(u32, t);
    const Vec y0 = first_pixel(a.y, b.y, c.y);
    const Vec y1 = last_pixel(a.y, b.y, c.y, views[0].height);
    const Mask in_rows =
        hn::And(hn::Le(y0, y1), hn::Gt(hn::Min(hn::Min(a.w, b.w), c.w), hn::Zero(f)));
    const Mask small_rows = hn::Le(hn::Sub(y1, y0), small);
    const auto view = [&](Vec ax, Vec bx, Vec cx, int width, VisibleTriangles& list) HWY_ATTR {
      // Counter-clockwise from outside is negative with y downwards.
      Vec area = hn::Neg(twice_area(ax, a.y, bx, b.y, cx, c.y));
      if (range.two_sided) area = hn::Abs(area);
      const Vec x0 = first_pixel(ax, bx, cx);
      const Vec x1 = last_pixel(ax, bx, cx, width);
      const Mask seen = hn::And(hn::And(in_rows, hn::Le(x0, x1)), hn::Gt(area, smallest));
      const Mask is_small = hn::And(small_rows, hn::Le(hn::Sub(x1, x0), small));
      append(numbers, hn::And(seen, is_small), list.small, list.small_count);
      append(numbers, hn::AndNot(is_small, seen), list.large, list.large_count);
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

// Whether all three barycentric coordinates are at least zero; false for NaN.
HWY_INLINE Mask inside(Vec a, Vec b) {
  const Vec c = hn::Sub(hn::Sub(hn::Set(f, 1.0f), a), b);
  return hn::Ge(hn::Min(hn::Min(a, b), c), hn::Set(f, -kInclusive));
}

HWY_INLINE Vec interpolate(const Planes& p, Vec a, Vec b) {
  return hn::MulAdd(a, p.w_ac, hn::MulAdd(b, p.w_bc, p.w_c));
}

// Draws kLanes small triangles: every lane steps through the pixels of its box; the covered ones
// are collected and then written one after the other, since several lanes may cover the same pixel.
HWY_INLINE void draw_small(const Planes& p, int stride, float* tile) {
  alignas(64) float inverse_depth[kLanes * (kSmall * kSmall + 1)];
  alignas(64) std::int32_t pixel[kLanes * (kSmall * kSmall + 1)];
  std::size_t count = 0;
  const Vec width = hn::Sub(p.x1, p.x0), height = hn::Sub(p.y1, p.y0);
  const auto columns = static_cast<int>(hn::GetLane(hn::MaxOfLanes(f, width)));
  const auto rows = static_cast<int>(hn::GetLane(hn::MaxOfLanes(f, height)));
  const auto origin =
      hn::Add(hn::Mul(hn::ConvertTo(s32, p.y0), hn::Set(s32, stride)), hn::ConvertTo(s32, p.x0));
  for (int dy = 0; dy <= rows; ++dy) {
    const Vec fy = hn::Set(f, static_cast<float>(dy));
    const Vec row_a = hn::MulAdd(fy, p.a_dy, p.a), row_b = hn::MulAdd(fy, p.b_dy, p.b);
    const Mask in_height = hn::Le(fy, height);
    for (int dx = 0; dx <= columns; ++dx) {
      const Vec fx = hn::Set(f, static_cast<float>(dx));
      const Vec a = hn::MulAdd(fx, p.a_dx, row_a), b = hn::MulAdd(fx, p.b_dx, row_b);
      // The box ends where the tile ends, and the triangle may not.
      const Mask covered = hn::And(inside(a, b), hn::And(in_height, hn::Le(fx, width)));
      const auto at = hn::Add(origin, hn::Set(s32, dy * stride + dx));
      hn::StoreU(hn::Compress(interpolate(p, a, b), covered), f, inverse_depth + count);
      hn::StoreU(hn::Compress(at, hn::RebindMask(s32, covered)), s32, pixel + count);
      count += hn::CountTrue(f, covered);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    float& nearest = tile[pixel[i]];
    nearest = inverse_depth[i] > nearest ? inverse_depth[i] : nearest;
  }
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
      const Mask covered = hn::And(inside(a, b), hn::Le(dx, last));
      const Vec w = hn::MulAdd(a, w_ac, hn::MulAdd(b, w_bc, w_c));
      const Vec nearest = hn::Load(f, row + x);
      hn::Store(hn::Max(nearest, hn::IfThenElseZero(covered, w)), f, row + x);
      dx = hn::Add(dx, hn::Set(f, static_cast<float>(kStep)));
    }
  }
}

void draw(const std::uint32_t* corners, std::uint32_t degenerate, const float* records, bool second,
          const ViewProjection& view, VisibleTriangles& visible, float* tile) {
  const auto padding = hn::Set(u32, degenerate);
  hn::StoreU(padding, u32, visible.small + visible.small_count);
  hn::StoreU(padding, u32, visible.large + visible.large_count);
  const auto planes_of = [&](const std::uint32_t* list) HWY_ATTR {
    const auto number = [list](std::size_t i) { return list[i]; };
    return make_planes(load_corners(corners, records, number), second, view);
  };
  for (std::size_t t = 0; t < visible.small_count; t += kLanes) {
    draw_small(planes_of(visible.small + t), view.stride, tile);
  }
  for (std::size_t t = 0; t < visible.large_count; t += kLanes) {
    Plane plane;
    store(planes_of(visible.large + t), plane);
    const std::size_t count = HWY_MIN(kLanes, visible.large_count - t);
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
