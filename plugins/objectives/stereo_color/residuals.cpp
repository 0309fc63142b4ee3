#include "residuals.hpp"

#include <algorithm>
#include <cmath>

#define HWY_TARGET_INCLUDE "residuals.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "color_lookup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_color::HWY_NAMESPACE {

template <bool kBilinear>
struct ResidualWriter {
  static constexpr bool kVisitsUncovered = false;

  const Features& left;
  const Features& right;
  SimilarityCurve<Lanes> curve;
  Lanes share;
  float* out;
  int width;
  LaneSum sum;
  std::int64_t seen = 0;
  std::int64_t rendered = 0;

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    const auto here = sample_here(left, p);
    const Lanes s = select(
        p.seen, color_consistency(here, sample_there<kBilinear>(right, p), curve), Lanes(0.0f));
    rendered += count(p.seen || p.occluded);
    seen += count(p.seen);
    sum.add(p.seen, s);
    store(color_residual(here.weight, s, share), p.pixels,
          out + static_cast<std::ptrdiff_t>(p.y) * width + p.x);
  }
  HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
};

template <bool kBilinear>
Similarity run(const ScoredView& here, const ScoredView& there, const StereoMap& map,
               const Params& params, float share, float* out) {
  ResidualWriter<kBilinear> writer{here.features,
                                   there.features,
                                   similarity_curve(params),
                                   Lanes(share),
                                   out,
                                   here.tile.width,
                                   {}};
  for_each_stereo_pixel(here.tile, there.tile, map, static_cast<float>(params.r),
                        covered_box(here.tile), writer);
  return {writer.sum.total(), writer.seen, writer.rendered};
}

Similarity write_covered(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                         const Params& params, float share, float* out) {
  return params.lookup == Lookup::bilinear ? run<true>(here, there, map, params, share, out)
                                           : run<false>(here, there, map, params, share, out);
}

}  // namespace hypotrack::stereo_color::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_color {

HWY_EXPORT(write_covered);

PixelPlane<float> uncovered_residuals(const Features& features, float share) {
  constexpr float kUnit = 1.0f / 65535.0f;
  const PixelPlane<std::uint32_t>& words = features.channel_2_weight;
  PixelPlane<float> plane(words.width(), words.height());
  for (int y = 0; y < words.height(); ++y) {
    std::transform(words.row(y), words.row(y) + words.width(), plane.row(y),
                   [&](std::uint32_t word) {
                     return std::sqrt(share * (static_cast<float>(word >> 16) * kUnit));
                   });
  }
  return plane;
}

Similarity write_residuals(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                           const Params& params, float share, const PixelPlane<float>& uncovered,
                           std::span<float> residuals) {
  std::copy_n(uncovered.row(0), residuals.size(), residuals.data());
  return HWY_DYNAMIC_DISPATCH(write_covered)(here, there, map, params, share, residuals.data());
}

}  // namespace hypotrack::stereo_color
#endif
