// Included once per instruction set: no #pragma once.
#if defined(STEREO_COLOR_COLOR_LOOKUP_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef STEREO_COLOR_COLOR_LOOKUP_INL_HPP_
#undef STEREO_COLOR_COLOR_LOOKUP_INL_HPP_
#else
#define STEREO_COLOR_COLOR_LOOKUP_INL_HPP_
#endif

#include "color_consistency-inl.hpp"
#include "features.hpp"
#include "hypotrack/stereo_pixels-inl.hpp"

/// Colours and weights of the pixels of a walk, in both views.
HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_color::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes and the walk

HYPOTRACK_PIXEL ColorSample<Lanes> unpack(WordLanes channels_01, WordLanes channel_2_weight) {
  return {unorm16_low(channels_01), unorm16_high(channels_01), unorm16_low(channel_2_weight),
          unorm16_high(channel_2_weight)};
}

HYPOTRACK_PIXEL ColorSample<Lanes> sample_here(const Features& features, const StereoPixels& p) {
  return unpack(p.here(features.channels_01), p.here(features.channel_2_weight));
}

HYPOTRACK_PIXEL ColorSample<Lanes> sample_at(const Features& features, const StereoPixels& p,
                                             IntLanes x, IntLanes y) {
  return unpack(p.at(features.channels_01, x, y), p.at(features.channel_2_weight, x, y));
}

/// Any value where not seen.
template <bool kBilinear>
HYPOTRACK_PIXEL ColorSample<Lanes> sample_there(const Features& features, const StereoPixels& p) {
  if constexpr (!kBilinear) return sample_at(features, p, p.column, p.row);
  const BilinearLanes b = p.bilinear();
  const auto at = [&](IntLanes x, IntLanes y) HWY_ATTR { return sample_at(features, p, x, y); };
  const IntLanes x1 = b.x0 + int_lanes(1), y1 = b.y0 + int_lanes(1);
  if (p.same_row) return blend(at(b.x0, p.row), at(x1, p.row), b.fx);
  const auto upper = blend(at(b.x0, b.y0), at(x1, b.y0), b.fx);
  return blend(upper, blend(at(b.x0, y1), at(x1, y1), b.fx), b.fy);
}

}  // namespace hypotrack::stereo_color::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
