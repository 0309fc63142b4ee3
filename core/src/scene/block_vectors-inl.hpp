// Included once per instruction set: no #pragma once.
#include <hwy/highway.h>

#include <cstddef>

#include "scene/simd_kernels.hpp"

// The vectors that the kernels work on: as long as the machine has them, kBlock floats at most.
HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, kBlock>;
using Vec = hn::Vec<F>;
using Mask = hn::Mask<F>;
constexpr F f;
constexpr std::size_t kLanes = hn::MaxLanes(F());

// Minimum and maximum, lane by lane. No default member values: a constructor that the compiler
// writes is not compiled for the target.
struct Range {
  Vec low, high;
  HWY_INLINE void add(Vec value) {
    low = hn::Min(low, value);
    high = hn::Max(high, value);
  }
  HWY_INLINE void add(Mask valid, Vec value) {
    low = hn::Min(low, hn::IfThenElse(valid, value, low));
    high = hn::Max(high, hn::IfThenElse(valid, value, high));
  }
  HWY_INLINE float lowest() const { return hn::GetLane(hn::MinOfLanes(f, low)); }
  HWY_INLINE float highest() const { return hn::GetLane(hn::MaxOfLanes(f, high)); }
};

// That of no values, where all that are added lie between -limit and limit.
HWY_INLINE Range no_range(float limit) { return {hn::Set(f, limit), hn::Set(f, -limit)}; }

// Row of a 3x4 matrix times (x y z 1), with fused multiply-add.
HWY_INLINE Vec transform_fused(const float* row, Vec x, Vec y, Vec z) {
  const Vec sum = hn::MulAdd(hn::Set(f, row[2]), z, hn::Set(f, row[3]));
  return hn::MulAdd(hn::Set(f, row[0]), x, hn::MulAdd(hn::Set(f, row[1]), y, sum));
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
