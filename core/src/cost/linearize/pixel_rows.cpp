#include "cost/linearize/pixel_rows.hpp"

#define HWY_TARGET_INCLUDE "cost/linearize/pixel_rows.cpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <hypotrack/plugin/foreach_target-inl.hpp>
#include <iterator>

#include "scene/block_vectors-inl.hpp"

#ifndef HYPOTRACK_PIXEL_ROWS_ONCE
#define HYPOTRACK_PIXEL_ROWS_ONCE
namespace hypotrack {
namespace {

alignas(64) constexpr float kLaneNumbers[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
static_assert(std::size(kLaneNumbers) == kBlock);

/// Input and output of the kernel.
struct Work {
  const DrawnView& drawn;
  std::span<const PixelSlopes> terms;
  float blur;
  TileRows rows;
  std::span<const std::uint32_t> triangles;
  std::size_t columns;
  const float* slopes;     ///< of all terms together, from the first row
  const float* residuals;  ///< belonging to `slopes`
  std::uint8_t* taken;
  std::uint8_t* known;
  float* motion;
  float* sums;
};

}  // namespace
}  // namespace hypotrack
#endif

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

constexpr std::size_t kRows = 64;  // rows multiplied together
// A larger step in depth (metres) means that the neighbour is another surface, behind this one.
constexpr float kStep = 0.006f;
// The rasteriser's tolerance, widened for the different order of operations here.
constexpr float kInclusive = 2e-5f;
constexpr float kSameDepth = 1e-5f;
// Flags of a vertex.
constexpr std::uint8_t kKnown = 1, kMoves = 2;

struct Point {
  float x, y, w;
};

/// Returns whether any row is not 0 in a block of columns.
HWY_INLINE bool is_used(const float* rows, std::size_t count, std::size_t columns,
                        std::size_t block) {
  Vec any = hn::Zero(f);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < kBlock; i += kLanes) {
      any = hn::Or(any, hn::Load(f, rows + k * columns + block + i));
    }
  }
  return !hn::AllTrue(f, hn::Eq(any, hn::Zero(f)));
}

/// Computes sums += rows^T rows, above the diagonal in blocks of kBlock. Pixels of one part of the
/// scene come together and depend on few columns. Columns behind the first `filled` are 0.
HWY_INLINE void multiply(const float* rows, std::size_t count, std::size_t columns,
                         std::size_t filled, float* sums) {
  constexpr std::size_t kSide = 8;
  constexpr std::size_t kWide = kBlock / kLanes;
  std::uint64_t used = 0;
  for (std::size_t c = 0; c < columns; c += kBlock) {
    if (is_used(rows, count, columns, c)) used |= std::uint64_t{1} << (c / kBlock % 64);
  }
  const auto has = [&](std::size_t c) { return (used >> (c / kBlock % 64) & 1) != 0; };
  for (std::size_t r = 0; r < filled; r += kSide) {
    if (!has(r)) continue;
    for (std::size_t c = r / kBlock * kBlock; c < columns; c += kBlock) {
      if (!has(c)) continue;
      for (std::size_t v = 0; v < kWide; ++v) {
        const std::size_t at = c + v * kLanes;
        Vec sum[kSide];
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kSide; ++i) sum[i] = hn::Zero(f);
        for (std::size_t k = 0; k < count; ++k) {
          const float* row = rows + k * columns;
          const Vec right = hn::Load(f, row + at);
#pragma GCC unroll 8
          for (std::size_t i = 0; i < kSide; ++i) {
            sum[i] = hn::MulAdd(hn::Set(f, row[r + i]), right, sum[i]);
          }
        }
#pragma GCC unroll 8
        for (std::size_t i = 0; i < kSide; ++i) {
          float* to = sums + (r + i) * columns + at;
          hn::StoreU(hn::Add(hn::LoadU(f, to), sum[i]), f, to);
        }
      }
    }
  }
}

class Walk {
 public:
  explicit Walk(const Work& work)
      : work_(work),
        d_(work.drawn),
        rows_(hwy::AllocateAligned<float>((kRows + 3) * work.columns)),
        surface_(rows_.get() + kRows * work.columns) {
    std::fill_n(rows_.get(), (kRows + 3) * work.columns, 0.0f);
    root_blur_ = std::sqrt(work.blur);
  }

  void run() {
    for (const std::uint32_t number : work_.triangles) triangle(number);
    flush();
  }

 private:
  Point point(std::uint32_t corner) const {
    const float* record = d_.records + corner;
    return {d_.second ? record[3] : record[0], record[1], record[2]};
  }

  /// Returns the motion of a vertex: rows of x, y and 1/z. Requires moves().
  const float* motion(std::uint32_t corner) const {
    return work_.motion + 3 * work_.columns * (corner / kRecord);
  }

  /// Returns whether any parameter moves a vertex; computes its motion.
  bool moves(std::uint32_t corner) {
    const std::size_t vertex = corner / kRecord;
    if (!(work_.known[vertex] & kKnown)) {
      work_.known[vertex] =
          find_motion(corner, work_.motion + 3 * work_.columns * vertex) ? kKnown | kMoves : kKnown;
    }
    return work_.known[vertex] & kMoves;
  }

  bool moves_any(const std::uint32_t* corners) {
    bool moved = false;
    for (int k = 0; k < 3; ++k) moved |= moves(corners[k]);
    return moved;
  }

  bool find_motion(std::uint32_t corner, float* rows) const {
    std::fill_n(rows, 3 * work_.columns, 0.0f);
    const Point here = point(corner);
    const int x = d_.second ? 3 : 0;
    const std::vector<int>& movers = d_.movers[corner / kRecord / kMoverBlock];
    for (const int i : movers) {
      const float* record = d_.beside[i] + corner;
      if (!(record[2] > 0)) continue;
      rows[i] = (record[x] - here.x) * d_.per_step[i];
      rows[work_.columns + i] = (record[1] - here.y) * d_.per_step[i];
      rows[2 * work_.columns + i] = (record[2] - here.w) * d_.per_step[i];
    }
    return !movers.empty();
  }

  void triangle(std::uint32_t number) {
    const std::uint32_t* corners = d_.plan->corners.data() + 4 * std::size_t{number};
    const Point a = point(corners[0]), b = point(corners[1]), c = point(corners[2]);
    const ViewProjection& view = *d_.view;
    const int x0 = static_cast<int>(std::ceil(std::max(std::min({a.x, b.x, c.x}), 0.0f)));
    const auto first_row = static_cast<float>(work_.rows.first);
    const auto last_row = static_cast<float>(work_.rows.end - 1);
    const int y0 = static_cast<int>(std::ceil(std::max(std::min({a.y, b.y, c.y}), first_row)));
    const float last_x = std::min(std::max({a.x, b.x, c.x}), static_cast<float>(view.width - 1));
    const float last_y = std::min(std::max({a.y, b.y, c.y}), last_row);
    const auto ox = static_cast<float>(x0), oy = static_cast<float>(y0);
    const float ax = a.x - ox, bx = b.x - ox, cx = c.x - ox;
    const float ay = a.y - oy, by = b.y - oy, cy = c.y - oy;
    const float scale = 1.0f / ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay));
    const float a_dx = (by - cy) * scale, a_dy = (cx - bx) * scale;
    const float b_dx = (cy - ay) * scale, b_dy = (ax - cx) * scale;
    const float a_0 = (bx * cy - cx * by) * scale, b_0 = (cx * ay - ax * cy) * scale;
    corners_ = corners;
    share_dx_ = a_dx * (a.w - c.w) + b_dx * (b.w - c.w);
    share_dy_ = a_dy * (a.w - c.w) + b_dy * (b.w - c.w);
    has_surface_ = false;
    bool moved = false;  // known once a pixel shows the triangle: most are small
    const Vec right_a = hn::Set(f, a_dx), right_b = hn::Set(f, b_dx), w_c = hn::Set(f, c.w);
    const Vec w_a = hn::Set(f, a.w - c.w), w_b = hn::Set(f, b.w - c.w);
    const Vec lanes = hn::Load(f, kLaneNumbers), one = hn::Set(f, 1.0f);
    const Vec width = hn::Set(f, last_x - ox);
    const int aligned_x0 = x0 - x0 % static_cast<int>(kLanes);  // as the tile's rows are
    for (int y = y0; static_cast<float>(y) <= last_y; ++y) {
      const auto dy = static_cast<float>(y - y0);
      const float* nearest = d_.tile + std::ptrdiff_t{y} * view.stride;
      for (int x = aligned_x0; static_cast<float>(x) <= last_x; x += static_cast<int>(kLanes)) {
        const Vec dx = hn::Add(lanes, hn::Set(f, static_cast<float>(x - x0)));
        const Vec share_a =
            hn::MulAdd(hn::Set(f, dy), hn::Set(f, a_dy), hn::MulAdd(dx, right_a, hn::Set(f, a_0)));
        const Vec share_b =
            hn::MulAdd(hn::Set(f, dy), hn::Set(f, b_dy), hn::MulAdd(dx, right_b, hn::Set(f, b_0)));
        const Vec share_c = hn::Sub(hn::Sub(one, share_a), share_b);
        const Vec w = hn::MulAdd(share_b, w_b, hn::MulAdd(share_a, w_a, w_c));
        const Mask inside =
            hn::Ge(hn::Min(hn::Min(share_a, share_b), share_c), hn::Set(f, -kInclusive));
        const Mask in_box = hn::And(hn::Ge(dx, hn::Zero(f)), hn::Le(dx, width));
        const Vec seen = hn::Mul(hn::Load(f, nearest + x), hn::Set(f, 1 - kSameDepth));
        const Mask shown = hn::And(hn::And(inside, in_box), hn::Ge(w, seen));
        if (hn::AllFalse(f, shown)) continue;
        if (!moved && !moves_any(corners)) return;
        moved = true;
        hn::Store(share_a, f, share_a_);
        hn::Store(share_b, f, share_b_);
        hn::Store(share_c, f, share_c_);
        hn::Store(w, f, w_);
        hn::StoreMaskBits(f, shown, shown_);
        for (std::uint32_t bits = shown_bits(); bits != 0; bits &= bits - 1)
          pixel_at(x, y, static_cast<std::size_t>(std::countr_zero(bits)));
      }
    }
  }

  std::uint32_t shown_bits() const {
    return kLanes <= 8 ? shown_[0] : shown_[0] | std::uint32_t{shown_[1]} << 8;
  }

  /// Takes the pixel of a lane of the vectors that begin at (x, y).
  void pixel_at(int x, int y, std::size_t lane) {
    x += static_cast<int>(lane);
    const int place = (y - work_.rows.first) * d_.view->width + x;
    if (work_.taken[place]) return;
    work_.taken[place] = 1;
    const float w = w_[lane];
    const float shares[3] = {share_a_[lane], share_b_[lane], share_c_[lane]};
    // On a surface seen at a grazing angle, a small motion moves the pixel far along it.
    const bool steep = std::max(std::abs(share_dx_), std::abs(share_dy_)) > kStep * w * w;
    if (work_.slopes[place] != 0 && !steep) surface(place, shares);
    edges(x, y, w, shares);
  }

  void edges(int x, int y, float w, const float (&shares)[3]) {
    const int width = d_.view->width, height = d_.view->height;
    const int at = y * width + x;
    if (x > 0) edge(at, at - 1, x - 1, y, w, shares, 0, -1);
    if (x + 1 < width) edge(at, at + 1, x + 1, y, w, shares, 0, 1);
    if (y > 0) edge(at, at - width, x, y - 1, w, shares, 1, -1);
    if (y + 1 < height) edge(at, at + width, x, y + 1, w, shares, 1, 1);
  }

  /// Computes the motion of 1/z on the rays through the three corners.
  void find_surface() {
    has_surface_ = true;
    const Vec dx = hn::Set(f, share_dx_), dy = hn::Set(f, share_dy_);
    for (std::size_t k = 0; k < 3; ++k) {
      const float* m = motion(corners_[k]);
      for (std::size_t i = 0; i < work_.columns; i += kLanes) {
        const Vec across =
            hn::MulAdd(dx, hn::Load(f, m + i), hn::Mul(dy, hn::Load(f, m + work_.columns + i)));
        hn::Store(hn::Sub(hn::Load(f, m + 2 * work_.columns + i), across), f,
                  surface_ + k * work_.columns + i);
      }
    }
  }

  void surface(int place, const float (&shares)[3]) {
    if (!has_surface_) find_surface();
    add_row(surface_, surface_ + work_.columns, surface_ + 2 * work_.columns, work_.slopes[place],
            work_.residuals[place], shares);
  }

  void edge(int p, int q, int x, int y, float w, const float (&shares)[3], std::size_t axis,
            float outwards) {
    const float behind = d_.tile[y * d_.view->stride + x];
    if (w - behind <= kStep * w * behind) return;
    float square = 0, product = 0;
    for (const PixelSlopes& term : work_.terms) {
      const float r_p = term.factor * term.residuals[p], r_q = term.factor * term.residuals[q];
      const float change = r_p - r_q;
      square += change * change;
      product += change * 0.5f * (r_p + r_q);
    }
    if (square == 0) return;
    const float change = std::sqrt(square);
    const std::size_t offset = axis * work_.columns;
    add_row(motion(corners_[0]) + offset, motion(corners_[1]) + offset,
            motion(corners_[2]) + offset, change * outwards / root_blur_,
            product / change * root_blur_, shares);
  }

  void add_row(const float* a, const float* b, const float* c, float factor, float residual,
               const float (&shares)[3]) {
    float* row = rows_.get() + count_ * work_.columns;
    const Vec fa = hn::Set(f, factor * shares[0]), fb = hn::Set(f, factor * shares[1]);
    const Vec fc = hn::Set(f, factor * shares[2]);
    for (std::size_t i = 0; i < work_.columns; i += kLanes) {
      const Vec sum =
          hn::MulAdd(fa, hn::Load(f, a + i),
                     hn::MulAdd(fb, hn::Load(f, b + i), hn::Mul(fc, hn::Load(f, c + i))));
      hn::Store(sum, f, row + i);
    }
    row[d_.dimension] = residual;
    if (++count_ == kRows) flush();
  }

  void flush() {
    multiply(rows_.get(), count_, work_.columns, static_cast<std::size_t>(d_.dimension) + 1,
             work_.sums);
    count_ = 0;
  }

  const Work& work_;
  const DrawnView& d_;
  AlignedFloats rows_;
  float* surface_;  // three rows
  std::size_t count_ = 0;
  float root_blur_ = 1;

  // The current triangle.
  const std::uint32_t* corners_ = nullptr;
  float share_dx_ = 0, share_dy_ = 0;  // gradient of 1/z in the image
  bool has_surface_ = false;
  // A row of its pixels: the corners' shares, 1/z and a bit for each that it shows.
  HWY_ALIGN float share_a_[kLanes], share_b_[kLanes], share_c_[kLanes], w_[kLanes];
  std::uint8_t shown_[8] = {};
};

void walk(const Work& work) { Walk(work).run(); }

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {
HWY_EXPORT(walk);
}  // namespace

void find_triangles(const DrawnView& drawn, std::span<const int> rows, BandTriangles& bands) {
  bands.resize(rows.size() - 1);
  for (std::vector<std::uint32_t>& band : bands) band.clear();
  std::vector<std::size_t> band_of;
  for (std::size_t band = 0; band < bands.size(); ++band)
    band_of.resize(static_cast<std::size_t>(std::max(rows[band + 1] - rows[0], 0)), band);
  if (band_of.empty()) return;
  const auto first = static_cast<float>(rows.front()), last = static_cast<float>(rows.back() - 1);
  const auto band_at = [&](int y) { return band_of[static_cast<std::size_t>(y - rows.front())]; };
  for (int i = 0; i < kSizeClasses; ++i) {
    for (std::size_t t = 0; t < drawn.visible->count[i]; ++t) {
      const std::uint32_t number = drawn.visible->list[i][t];
      const std::uint32_t* corners = drawn.plan->corners.data() + 4 * std::size_t{number};
      const auto y = [&](int k) { return drawn.records[corners[k] + 1]; };
      const float highest = std::max(std::min({y(0), y(1), y(2)}), first);
      const float lowest = std::min(std::max({y(0), y(1), y(2)}), last);
      // Not std::ceil, which is a call.
      auto top = static_cast<int>(highest);
      if (static_cast<float>(top) < highest) ++top;
      const auto bottom = static_cast<int>(lowest);
      if (top > bottom) continue;
      for (std::size_t band = band_at(top); band <= band_at(bottom); ++band)
        bands[band].push_back(number);
    }
  }
}

void PixelRows::sum(const DrawnView& drawn, std::span<const PixelSlopes> terms, float blur,
                    TileRows rows, std::span<const std::uint32_t> triangles) {
  columns_ = (static_cast<std::size_t>(drawn.dimension) + 1 + kBlock - 1) / kBlock * kBlock;
  sums_.assign(columns_ * columns_, 0.0f);
  known_.assign(drawn.plan->vertex_count, 0);
  const std::size_t size = 3 * columns_ * drawn.plan->vertex_count;
  if (motion_size_ < size) {
    motion_ = hwy::AllocateAligned<float>(size);
    motion_size_ = size;
  }
  taken_.assign(static_cast<std::size_t>(drawn.view->width) *
                    static_cast<std::size_t>(std::max(rows.end - rows.first, 0)),
                0);
  join_terms(terms, drawn.view->width, rows);
  HWY_DYNAMIC_DISPATCH(walk)
  ({drawn, terms, blur, rows, triangles, columns_, slopes_.data(), residuals_.data(), taken_.data(),
    known_.data(), motion_.get(), sums_.data()});
}

void PixelRows::join_terms(std::span<const PixelSlopes> terms, int width, TileRows rows) {
  using Pixels = Eigen::Map<const Eigen::ArrayXf>;
  const Eigen::Index first = Eigen::Index{width} * rows.first;
  const Eigen::Index count = Eigen::Index{width} * std::max(rows.end - rows.first, 0);
  slopes_.setZero(count);
  residuals_.setZero(count);
  for (const PixelSlopes& term : terms) {
    const Pixels slopes(term.slopes + first, count), residuals(term.residuals + first, count);
    slopes_ += (term.factor * slopes).square();
    residuals_ += (term.factor * slopes) * (term.factor * residuals);
  }
  slopes_ = slopes_.sqrt();
  residuals_ /= slopes_;  // not read where the slope is 0
}

}  // namespace hypotrack::internal
#endif
