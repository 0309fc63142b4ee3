// Compiled once for every instruction set: the include below includes this file again. Without
// fused multiply-add (see CMakeLists.txt): where a tile lies must not depend on the machine.

#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "evaluate/bounds_kernel.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <limits>

#include "evaluate/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, kBlock>;
using Vec = hn::Vec<F>;
constexpr F f;
constexpr std::size_t kLanes = hn::MaxLanes(F());

HWY_INLINE Vec transform(const float* row, Vec x, Vec y, Vec z) {
  const Vec xy = hn::Add(hn::Mul(hn::Set(f, row[0]), x), hn::Mul(hn::Set(f, row[1]), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(f, row[2]), z)), hn::Set(f, row[3]));
}

// No default member values: a constructor that the compiler writes is not compiled for the target.
struct Range {
  Vec low, high;
  HWY_INLINE void add(Vec value) {
    low = hn::Min(low, value);
    high = hn::Max(high, value);
  }
};

void bound(const float* in_x, const float* in_y, const float* in_z, std::size_t count,
           const float* m, PlaneBounds& bounds) {
  const Vec zero = hn::Zero(f);
  const Vec none = hn::Set(f, std::numeric_limits<float>::infinity());
  Range across{none, hn::Neg(none)}, down = across;
  Vec nearest = none;
  Vec poison = zero;  // NaN once anything is not finite
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Vec px = hn::Load(f, in_x + i), py = hn::Load(f, in_y + i), pz = hn::Load(f, in_z + i);
    const Vec x = transform(m, px, py, pz);
    const Vec y = transform(m + 4, px, py, pz);
    const Vec z = transform(m + 8, px, py, pz);
    across.add(hn::Div(x, z));
    down.add(hn::Div(y, z));
    nearest = hn::Min(nearest, z);
    poison = hn::Add(poison, hn::Mul(zero, hn::Add(hn::Add(x, y), z)));
  }
  bounds.x0 = hn::GetLane(hn::MinOfLanes(f, across.low));
  bounds.x1 = hn::GetLane(hn::MaxOfLanes(f, across.high));
  bounds.y0 = hn::GetLane(hn::MinOfLanes(f, down.low));
  bounds.y1 = hn::GetLane(hn::MaxOfLanes(f, down.high));
  bounds.nearest = hn::GetLane(hn::Add(hn::MinOfLanes(f, nearest), hn::SumOfLanes(f, poison)));
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack {
namespace {
HWY_EXPORT(bound);
}  // namespace

void bound_points(const float* x, const float* y, const float* z, std::size_t count,
                  const float* camera_from_first, PlaneBounds& bounds) {
  HWY_DYNAMIC_DISPATCH(bound)(x, y, z, count, camera_from_first, bounds);
}

}  // namespace hypotrack
#endif
