// Included once per instruction set: no #pragma once.
#if defined(HYPOTRACK_SIMD_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef HYPOTRACK_SIMD_INL_HPP_
#undef HYPOTRACK_SIMD_INL_HPP_
#else
#define HYPOTRACK_SIMD_INL_HPP_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "hypotrack/plugin/pixel.hpp"

// From here on, per-pixel functions of this translation unit belong to the current instruction set.
#undef HYPOTRACK_TARGET
#undef HYPOTRACK_PIXEL_BEGIN
#undef HYPOTRACK_PIXEL_END
#define HYPOTRACK_TARGET HWY_NAMESPACE
#define HYPOTRACK_PIXEL_BEGIN() HWY_BEFORE_NAMESPACE()
#define HYPOTRACK_PIXEL_END() HWY_AFTER_NAMESPACE()

#if HWY_HAVE_SCALABLE
#error "Lanes holds a vector as a member: include <hypotrack/plugin/foreach_target-inl.hpp> first"
#endif

/// SIMD vectors with the operations of pixel.hpp, for sources that are compiled once per
/// instruction set. Such a source, my_term.cpp, looks like this (its folder must be on the include
/// path):
///
///   #define HWY_TARGET_INCLUDE "my_term.cpp"  // is included again for every instruction set
///   #include <hypotrack/plugin/foreach_target-inl.hpp>
///   #include "my_term-inl.hpp"                // per-pixel functions
///   HWY_BEFORE_NAMESPACE();
///   namespace my::HWY_NAMESPACE {
///   ...                                       // code over Lanes
///   }  // namespace my::HWY_NAMESPACE
///   HWY_AFTER_NAMESPACE();
///   #if HWY_ONCE
///   ...                                       // HWY_EXPORT, HWY_DYNAMIC_DISPATCH
///   #endif
///
/// plugins/objectives/stereo_color/score.cpp is an example. A target that includes this header must
/// link Highway (libhwy); no other public header needs it. The compiler does not apply the
/// instruction set to implicit functions. So write HWY_ATTR on lambdas, and give structs that hold
/// Lanes and have default member values a constructor.
#ifndef HYPOTRACK_LANE_NUMBERS_
#define HYPOTRACK_LANE_NUMBERS_
namespace hypotrack::pixel {
alignas(64) inline constexpr float kLaneNumbers[] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                     8, 9, 10, 11, 12, 13, 14, 15};
}  // namespace hypotrack::pixel
#endif

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::ScalableTag<std::int32_t>;
using UintTag = hn::ScalableTag<std::uint32_t>;

/// Lanes per vector.
inline constexpr int kLanes = static_cast<int>(hn::MaxLanes(FloatTag()));
static_assert(kLanes <= 16);

/// One bool per lane.
struct LaneMask {
  hn::Mask<FloatTag> m;
};
HYPOTRACK_PIXEL LaneMask operator&&(LaneMask a, LaneMask b) { return {hn::And(a.m, b.m)}; }
HYPOTRACK_PIXEL LaneMask operator||(LaneMask a, LaneMask b) { return {hn::Or(a.m, b.m)}; }
HYPOTRACK_PIXEL LaneMask operator!(LaneMask a) { return {hn::Not(a.m)}; }
HYPOTRACK_PIXEL bool any(LaneMask a) { return !hn::AllFalse(FloatTag(), a.m); }
HYPOTRACK_PIXEL bool all(LaneMask a) { return hn::AllTrue(FloatTag(), a.m); }
/// Returns the number of set lanes.
HYPOTRACK_PIXEL int count(LaneMask a) { return static_cast<int>(hn::CountTrue(FloatTag(), a.m)); }
/// Returns the index of the first set lane; -1 if none is set.
HYPOTRACK_PIXEL int first(LaneMask a) {
  return static_cast<int>(hn::FindFirstTrue(FloatTag(), a.m));
}
/// One float per lane.
struct Lanes {
  hn::Vec<FloatTag> v;
  Lanes() = default;
  HYPOTRACK_PIXEL Lanes(float x) : v(hn::Set(FloatTag(), x)) {}
  HYPOTRACK_PIXEL explicit Lanes(hn::Vec<FloatTag> x) : v(x) {}
};
HYPOTRACK_PIXEL Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.v, b.v)); }
HYPOTRACK_PIXEL Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.v, b.v)); }
HYPOTRACK_PIXEL Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.v, b.v)); }
HYPOTRACK_PIXEL Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.v, b.v)); }
HYPOTRACK_PIXEL Lanes operator-(Lanes a) { return Lanes(hn::Neg(a.v)); }
HYPOTRACK_PIXEL LaneMask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
HYPOTRACK_PIXEL LaneMask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
HYPOTRACK_PIXEL LaneMask operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
HYPOTRACK_PIXEL LaneMask operator>=(Lanes a, Lanes b) { return {hn::Ge(a.v, b.v)}; }
HYPOTRACK_PIXEL LaneMask operator==(Lanes a, Lanes b) { return {hn::Eq(a.v, b.v)}; }

HYPOTRACK_PIXEL Lanes min(Lanes a, Lanes b) { return Lanes(hn::Min(a.v, b.v)); }
HYPOTRACK_PIXEL Lanes max(Lanes a, Lanes b) { return Lanes(hn::Max(a.v, b.v)); }
HYPOTRACK_PIXEL Lanes abs(Lanes a) { return Lanes(hn::Abs(a.v)); }
HYPOTRACK_PIXEL Lanes sqrt(Lanes a) { return Lanes(hn::Sqrt(a.v)); }
HYPOTRACK_PIXEL Lanes quick_sqrt(Lanes a) { return sqrt(a); }
HYPOTRACK_PIXEL Lanes floor(Lanes a) { return Lanes(hn::Floor(a.v)); }
HYPOTRACK_PIXEL Lanes round(Lanes a) { return Lanes(hn::Round(a.v)); }
HYPOTRACK_PIXEL Lanes mul_add(Lanes a, Lanes b, Lanes c) {
  return Lanes(hn::MulAdd(a.v, b.v, c.v));
}
HYPOTRACK_PIXEL Lanes select(LaneMask mask, Lanes yes, Lanes no) {
  return Lanes(hn::IfThenElse(mask.m, yes.v, no.v));
}

/// Returns e^x per lane; see pixel::exp for accuracy and range.
HYPOTRACK_PIXEL Lanes exp(Lanes x) {
  using namespace pixel;  // the coefficients
  const IntTag int_tag;
  x = Lanes(hn::Min(hn::Max(x.v, Lanes(kExpLowest).v), Lanes(kExpHighest).v));
  const auto n = hn::NearestInt(hn::Mul(x.v, Lanes(kLog2E).v));
  const Lanes n_float(hn::ConvertTo(FloatTag(), n));
  const Lanes r = hypotrack::HWY_NAMESPACE::mul_add(
      n_float, Lanes(-kLn2Low), hypotrack::HWY_NAMESPACE::mul_add(n_float, Lanes(-kLn2High), x));
  auto p = hn::MulAdd(Lanes(kExp6).v, r.v, Lanes(kExp5).v);
  p = hn::MulAdd(p, r.v, Lanes(kExp4).v);
  p = hn::MulAdd(p, r.v, Lanes(kExp3).v);
  p = hn::MulAdd(p, r.v, Lanes(kExp2).v);
  p = hn::Add(hn::MulAdd(hn::Mul(p, r.v), r.v, r.v), Lanes(1.0f).v);
  const auto scale = hn::ShiftLeft<23>(hn::Add(n, hn::Set(int_tag, 127)));
  return Lanes(hn::Mul(p, hn::BitCast(FloatTag(), scale)));
}

/// Returns the sum of all lanes.
HYPOTRACK_PIXEL float sum(Lanes a) { return hn::GetLane(hn::SumOfLanes(FloatTag(), a.v)); }
/// Returns start, start + 1, start + 2, ...
HYPOTRACK_PIXEL Lanes count_from(float start) {
  // Highway's Iota() is a loop over memory on some instruction sets.
  return Lanes(hn::Add(hn::Load(FloatTag(), pixel::kLaneNumbers), Lanes(start).v));
}
/// Returns a mask of the first n lanes, n <= kLanes.
HYPOTRACK_PIXEL LaneMask first_lanes(int n) {
  return {hn::Lt(hn::Load(FloatTag(), pixel::kLaneNumbers), Lanes(static_cast<float>(n)).v)};
}

/// One 32-bit integer per lane: columns, rows, indices.
struct IntLanes {
  hn::Vec<IntTag> v;
};
HYPOTRACK_PIXEL IntLanes operator+(IntLanes a, IntLanes b) { return {hn::Add(a.v, b.v)}; }
HYPOTRACK_PIXEL IntLanes operator*(IntLanes a, IntLanes b) { return {hn::Mul(a.v, b.v)}; }
HYPOTRACK_PIXEL IntLanes int_lanes(int x) { return {hn::Set(IntTag(), x)}; }
/// Rounds to the nearest integers, ties to even.
HYPOTRACK_PIXEL IntLanes to_int(Lanes a) { return {hn::NearestInt(a.v)}; }
HYPOTRACK_PIXEL Lanes to_float(IntLanes a) { return Lanes(hn::ConvertTo(FloatTag(), a.v)); }

/// One 32-bit word per lane: packed features.
struct WordLanes {
  hn::Vec<UintTag> v;
};
/// Unpacks the lower or the upper 16 bits to numbers in 0 .. 1 (see pack_unorm16()).
HYPOTRACK_PIXEL Lanes unorm16_low(WordLanes a) {
  const auto half = hn::And(a.v, hn::Set(UintTag(), 0xFFFFu));
  return Lanes(hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), half))) * Lanes(1.0f / 65535.0f);
}
HYPOTRACK_PIXEL Lanes unorm16_high(WordLanes a) {
  const auto half = hn::ShiftRight<16>(a.v);
  return Lanes(hn::ConvertTo(FloatTag(), hn::BitCast(IntTag(), half))) * Lanes(1.0f / 65535.0f);
}

/// Loads consecutive values, one per lane; kLanes of them must be readable.
HYPOTRACK_PIXEL Lanes load(const float* from) { return Lanes(hn::LoadU(FloatTag(), from)); }
HYPOTRACK_PIXEL WordLanes load(const std::uint32_t* from) { return {hn::LoadU(UintTag(), from)}; }
/// Stores the first n lanes, n <= kLanes.
HYPOTRACK_PIXEL void store(Lanes a, int n, float* to) {
  if (HWY_LIKELY(n == kLanes)) return hn::StoreU(a.v, FloatTag(), to);
  HWY_ALIGN float copy[kLanes];
  hn::Store(a.v, FloatTag(), copy);
  for (int i = 0; i < n; ++i) to[i] = copy[i];
}
/// Loads base[index] per lane.
HYPOTRACK_PIXEL Lanes gather(const float* base, IntLanes index) {
  return Lanes(hn::GatherIndex(FloatTag(), base, index.v));
}
HYPOTRACK_PIXEL WordLanes gather(const std::uint32_t* base, IntLanes index) {
  return {hn::GatherIndex(UintTag(), base, index.v)};
}

/// A sum over many vectors: in float within a row, in double over rows. The vector width changes
/// its value only by rounding (about 1e-7 relative).
class LaneSum {
 public:
  // Not `= default`: an implicit constructor would not be compiled for the instruction set.
  HYPOTRACK_PIXEL LaneSum() : row_(0.0f), total_(0) {}
  HYPOTRACK_PIXEL void add(LaneMask mask, Lanes a) {
    row_ = row_ + Lanes(hn::IfThenElseZero(mask.m, a.v));
  }
  HYPOTRACK_PIXEL void end_row() {
    total_ += static_cast<double>(sum(row_));
    row_ = Lanes(0.0f);
  }
  HYPOTRACK_PIXEL double total() const { return total_; }

 private:
  Lanes row_;
  double total_;
};

}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
