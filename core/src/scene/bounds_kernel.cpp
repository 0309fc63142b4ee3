// Compiled once per instruction set: the include below includes this file again. Compiled without
// fused multiply-add (see CMakeLists.txt), because a tile's position must not depend on the
// machine.

#define HWY_TARGET_INCLUDE "scene/bounds_kernel.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>
#include <limits>

#include "scene/block_vectors-inl.hpp"
#include "scene/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

HWY_INLINE Vec transform(const float* row, Vec x, Vec y, Vec z) {
  const Vec xy = hn::Add(hn::Mul(hn::Set(f, row[0]), x), hn::Mul(hn::Set(f, row[1]), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(f, row[2]), z)), hn::Set(f, row[3]));
}

void bound(const float* in_x, const float* in_y, const float* in_z, std::size_t count,
           const float* m, PlaneBounds& bounds) {
  const Vec zero = hn::Zero(f);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Range across = no_range(kInfinity), down = across;
  Vec nearest = hn::Set(f, kInfinity);
  Vec poison = zero;  // NaN once any value is not finite
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
  bounds.x0 = across.lowest();
  bounds.x1 = across.highest();
  bounds.y0 = down.lowest();
  bounds.y1 = down.highest();
  bounds.nearest = hn::GetLane(hn::Add(hn::MinOfLanes(f, nearest), hn::SumOfLanes(f, poison)));
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {
HWY_EXPORT(bound);
}  // namespace

void bound_points(const float* x, const float* y, const float* z, std::size_t count,
                  const float* camera_from_first, PlaneBounds& bounds) {
  HWY_DYNAMIC_DISPATCH(bound)(x, y, z, count, camera_from_first, bounds);
}

}  // namespace hypotrack::internal
#endif
