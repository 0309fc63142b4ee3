// Included once per instruction set: no #pragma once.
#if defined(STEREO_COLOR_COLOR_LOOKUP_INL_HPP_) == defined(HWY_TARGET_TOGGLE)
#ifdef STEREO_COLOR_COLOR_LOOKUP_INL_HPP_
#undef STEREO_COLOR_COLOR_LOOKUP_INL_HPP_
#else
#define STEREO_COLOR_COLOR_LOOKUP_INL_HPP_
#endif

#include "color_consistency-inl.hpp"
#include "features.hpp"
#include "hypotrack/plugin/stereo_pixels-inl.hpp"

/// Looks up colours and weights of the pixels of a walk, in both views.
HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_color::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes and the walk

HYPOTRACK_PIXEL SimilarityCurve<Lanes> similarity_curve(const Settings& settings) {
  return {Lanes(static_cast<float>(settings.beta)),
          Lanes(static_cast<float>(settings.coverage_penalty)),
          settings.falloff == Falloff::gaussian};
}

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

/// Interpolates between two pixels of a row.
HYPOTRACK_PIXEL ColorSample<Lanes> blend_row(const Features& features, const StereoPixels& p,
                                             const BilinearLanes& b, IntLanes row) {
  return blend(sample_at(features, p, b.x0, row), sample_at(features, p, b.x0 + int_lanes(1), row),
               b.fx);
}

/// Samples the other view; the result is arbitrary where not seen.
template <bool kBilinear>
HYPOTRACK_PIXEL ColorSample<Lanes> sample_there(const Features& features, const StereoPixels& p) {
  if constexpr (!kBilinear) return sample_at(features, p, p.column, p.row);
  const BilinearLanes b = p.bilinear();
  if (p.same_row) return blend_row(features, p, b, p.row);
  return blend(blend_row(features, p, b, b.y0), blend_row(features, p, b, b.y0 + int_lanes(1)),
               b.fy);
}

}  // namespace hypotrack::stereo_color::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
