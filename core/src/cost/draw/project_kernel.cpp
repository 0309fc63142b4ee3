// Compiled once per instruction set: the include below includes this file again.

#define HWY_TARGET_INCLUDE "cost/draw/project_kernel.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "cost/draw/raster_kernels.hpp"
#include "scene/block_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::HWY_NAMESPACE {
namespace {

// A coordinate beyond all valid ones.
constexpr float kBeyond = 2 * kGuard;

HWY_INLINE Mask within_guard(Vec value) {
  return hn::Le(hn::Abs(value), hn::Set(f, kGuard));  // false for NaN
}

HWY_INLINE Mask within_depth(Vec z) {
  return hn::And(hn::Ge(z, hn::Set(f, kNear)), hn::Le(z, hn::Set(f, kFar)));
}

void project_one(const float* in_x, const float* in_y, const float* in_z, std::size_t count,
                 const ViewProjection& view, float* records, PixelRange& range) {
  const float* m = view.camera_from_first;
  const Vec one = hn::Set(f, 1.0f), zero = hn::Zero(f);
  Range range_x = no_range(kBeyond), range_y = no_range(kBeyond);
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Vec px = hn::Load(f, in_x + i), py = hn::Load(f, in_y + i), pz = hn::Load(f, in_z + i);
    const Vec z = transform_fused(m + 8, px, py, pz);
    const Vec w = hn::Div(one, z);
    const Vec x = hn::MulAdd(hn::Mul(transform_fused(m, px, py, pz), w), hn::Set(f, view.fx),
                             hn::Set(f, view.cx));
    const Vec y = hn::MulAdd(hn::Mul(transform_fused(m + 4, px, py, pz), w), hn::Set(f, view.fy),
                             hn::Set(f, view.cy));
    const Mask valid = hn::And(within_depth(z), hn::And(within_guard(x), within_guard(y)));
    range_x.add(valid, x);
    range_y.add(valid, y);
    hn::StoreInterleaved4(hn::IfThenElseZero(valid, x), hn::IfThenElseZero(valid, y),
                          hn::IfThenElseZero(valid, w), zero, f, records + i * kRecord);
  }
  range = {range_x.lowest(), range_x.highest(), range_y.lowest(), range_y.highest()};
}

void project_both(const float* in_x, const float* in_y, const float* in_z, std::size_t count,
                  const ViewProjection* views, float* records, PixelRange* ranges) {
  const ViewProjection& left = views[0];
  const ViewProjection& right = views[1];
  const Vec one = hn::Set(f, 1.0f);
  // x_right = cx_right + fx (X + t) / Z = x_left + (cx_right - cx_left) + fx t / Z.
  const Vec shift = hn::Set(f, right.cx - left.cx);
  const Vec parallax = hn::Set(f, right.fx * right.camera_from_first[3]);
  Range range_left = no_range(kBeyond), range_right = no_range(kBeyond),
        range_y = no_range(kBeyond);
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Vec z = hn::Load(f, in_z + i);
    const Vec w = hn::Div(one, z);
    const Vec x =
        hn::MulAdd(hn::Mul(hn::Load(f, in_x + i), w), hn::Set(f, left.fx), hn::Set(f, left.cx));
    const Vec y =
        hn::MulAdd(hn::Mul(hn::Load(f, in_y + i), w), hn::Set(f, left.fy), hn::Set(f, left.cy));
    const Vec x_right = hn::MulAdd(parallax, w, hn::Add(x, shift));
    const Mask valid = hn::And(hn::And(within_depth(z), within_guard(x_right)),
                               hn::And(within_guard(x), within_guard(y)));
    range_left.add(valid, x);
    range_right.add(valid, x_right);
    range_y.add(valid, y);
    hn::StoreInterleaved4(hn::IfThenElseZero(valid, x), hn::IfThenElseZero(valid, y),
                          hn::IfThenElseZero(valid, w), hn::IfThenElseZero(valid, x_right), f,
                          records + i * kRecord);
  }
  const float low_y = range_y.lowest(), high_y = range_y.highest();
  ranges[0] = {range_left.lowest(), range_left.highest(), low_y, high_y};
  ranges[1] = {range_right.lowest(), range_right.highest(), low_y, high_y};
}

}  // namespace
}  // namespace hypotrack::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::internal {
namespace {
HWY_EXPORT(project_one);
HWY_EXPORT(project_both);
}  // namespace

void project_view(const float* x, const float* y, const float* z, std::size_t count,
                  const ViewProjection& view, float* records, PixelRange& range) {
  HWY_DYNAMIC_DISPATCH(project_one)(x, y, z, count, view, records, range);
}

void project_pair(const float* x, const float* y, const float* z, std::size_t count,
                  const ViewProjection* views, float* records, PixelRange* ranges) {
  HWY_DYNAMIC_DISPATCH(project_both)(x, y, z, count, views, records, ranges);
}

}  // namespace hypotrack::internal
#endif
