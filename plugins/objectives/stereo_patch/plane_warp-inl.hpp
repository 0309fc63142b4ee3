// Included once per instruction set: no #pragma once.
#if defined(STEREO_PATCH_PLANE_WARP_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef STEREO_PATCH_PLANE_WARP_INL_HPP_
#undef STEREO_PATCH_PLANE_WARP_INL_HPP_
#else
#define STEREO_PATCH_PLANE_WARP_INL_HPP_
#endif

#include "hypotrack/plugin/simd-inl.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"
#include "volume_kernel.hpp"

/// Warps the second view to the first by a plane in space that is parallel to the first view's
/// tile.
HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes

/// Warps a row of a rectified pair: shifts it by a fraction of pixels.
HYPOTRACK_PIXEL void shift_row(const VolumeJob& job, float offset, int y, PixelPlane<float>& out) {
  const float whole = std::floor(offset);
  const auto margin = static_cast<float>(job.margin);
  // Clamp the shift: beyond the image there are only the margins' NaNs.
  const int shift = static_cast<int>(std::min(std::max(whole, -margin), margin - 1));
  const Lanes share(offset - whole);
  const float* from = job.right.row(y) + job.margin + shift;
  for (int x = 0; x < out.width(); x += kLanes) {
    const Lanes a = load(from + x), b = load(from + x + 1);
    const Lanes value = mul_add(b - a, share, a);
    hn::StoreU(value.v, FloatTag(), out.row(y) + x);
  }
}

/// Two neighbouring numbers of a row, per lane.
struct PairLanes {
  Lanes first, second;
};

/// Returns from[index] and from[index + 1]. A gather takes as long for 64 bits as for 32.
HYPOTRACK_PIXEL PairLanes gather_pairs(const float* from, IntLanes index) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
  const hn::RepartitionToWide<IntTag> wide;
  const auto* base = reinterpret_cast<const hn::TFromD<decltype(wide)>*>(from);
  const auto bytes = hn::ShiftLeft<2>(index.v);
  const hn::Half<IntTag> half;
  const auto low = hn::GatherOffset(wide, base, hn::PromoteTo(wide, hn::LowerHalf(half, bytes)));
  const auto high = hn::GatherOffset(wide, base, hn::PromoteTo(wide, hn::UpperHalf(half, bytes)));
  const FloatTag tag;
  const auto a = hn::BitCast(tag, low), b = hn::BitCast(tag, high);
  return {Lanes{hn::ConcatEven(tag, b, a)}, Lanes{hn::ConcatOdd(tag, b, a)}};
#else
  return {gather(from, index), gather(from, index + int_lanes(1))};
#endif
}

/// Warps a row for any two cameras: looks up every pixel by bilinear interpolation.
HYPOTRACK_PIXEL void look_up_row(const VolumeJob& job, float inverse_depth, int y,
                                 PixelPlane<float>& out) {
  const Lanes right(static_cast<float>(job.map.width - 1));
  const Lanes low(static_cast<float>(job.map.height - 1));
  const Lanes zero(0.0f), one(1.0f);
  for (int x = 0; x < out.width(); x += kLanes) {
    const auto m = hypotrack::HWY_NAMESPACE::map_pixel<false>(
        job.map, count_from(static_cast<float>(x)), Lanes(static_cast<float>(y)),
        Lanes(inverse_depth));
    const LaneMask within =
        m.u >= zero && m.u <= right && m.v >= zero && m.v <= low && m.inverse_depth > zero;
    const Lanes u = select(within, m.u, zero), v = select(within, m.v, zero);
    const Lanes x0 = min(floor(u), right - one), y0 = min(floor(v), low - one);
    const Lanes fx = u - x0, fy = v - y0;
    const IntLanes first =
        to_int(y0) * int_lanes(job.right.width()) + to_int(x0) + int_lanes(job.margin);
    const auto blend = [&](int beyond) HWY_ATTR {
      const PairLanes pair = gather_pairs(job.right.row(0), first + int_lanes(beyond));
      return mul_add(pair.second - pair.first, fx, pair.first);
    };
    const Lanes upper = blend(0), lower = blend(job.right.width());
    const Lanes value = mul_add(lower - upper, fy, upper);
    const Lanes nowhere(std::numeric_limits<float>::quiet_NaN());
    hn::StoreU(select(within, value, nowhere).v, FloatTag(), out.row(y) + x);
  }
}

/// Warps the view for rows `first` to `end` - 1 of the first view. `out` has that view's size; NaN
/// where the plane does not show a valid pixel.
HYPOTRACK_PIXEL void warp(const VolumeJob& job, float inverse_depth, int first, int end,
                          PixelPlane<float>& out) {
  const int rows = std::min(out.height(), job.right.height());
  for (int y = first; y < end; ++y) {
    if (!job.map.rectified) {
      look_up_row(job, inverse_depth, y, out);
    } else if (y < rows) {
      shift_row(job, job.map.a[0][2] + job.map.b[0] * inverse_depth, y, out);
    }
  }
}

}  // namespace hypotrack::stereo_patch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
