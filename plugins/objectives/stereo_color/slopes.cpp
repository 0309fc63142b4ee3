#include <algorithm>

#include "residuals.hpp"

#define HWY_TARGET_INCLUDE "slopes.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "color_lookup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_color::HWY_NAMESPACE {

template <bool kBilinear>
struct SlopeWriter {
  static constexpr bool kVisitsUncovered = false;

  const Features& left;
  const Features& right;
  const StereoMap& map;
  SimilarityCurve<Lanes> curve;
  Lanes share;
  float* residuals;
  float* slopes;
  int width;

  template <bool kInterpolated>
  HYPOTRACK_PIXEL Lanes residual(const ColorSample<Lanes>& here, const StereoPixels& p) const {
    const Lanes s = color_consistency(here, sample_there<kInterpolated>(right, p), curve);
    return sqrt(share * max(here.weight - s, Lanes(0.0f)));
  }

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(p.y) * width + p.x;
    const auto here = sample_here(left, p);
    const Lanes zero(0.0f);
    store(select(p.seen, residual<kBilinear>(here, p), sqrt(share * here.weight)), p.pixels,
          residuals + at);
    if (!any(p.seen)) return;
    const auto motion = epipolar_motion(map, count_from(static_cast<float>(p.x)),
                                        Lanes(static_cast<float>(p.y)), p.inverse_depth, p.u, p.v);
    StereoPixels near = p, far = p;
    near.u = mul_add(motion.along_u, Lanes(kSlopeReach), p.u);
    near.v = mul_add(motion.along_v, Lanes(kSlopeReach), p.v);
    far.u = mul_add(motion.along_u, Lanes(-kSlopeReach), p.u);
    far.v = mul_add(motion.along_v, Lanes(-kSlopeReach), p.v);
    const Lanes slope = (residual<true>(here, near) - residual<true>(here, far)) * motion.speed *
                        Lanes(0.5f / kSlopeReach);
    store(select(p.seen, slope, zero), p.pixels, slopes + at);
  }
  HYPOTRACK_PIXEL void end_row() {}
};

template <bool kBilinear>
void run(const ScoredView& here, const ScoredView& there, const StereoMap& map,
         const Params& params, float share, float* residuals, float* slopes) {
  SlopeWriter<kBilinear> writer{here.features, there.features, map,    similarity_curve(params),
                                Lanes(share),  residuals,      slopes, here.tile.width};
  for_each_stereo_pixel(here.tile, there.tile, map, static_cast<float>(params.r),
                        covered_box(here.tile), writer);
}

void write_slopes_covered(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                          const Params& params, float share, float* residuals, float* slopes) {
  if (params.lookup == Lookup::bilinear) {
    run<true>(here, there, map, params, share, residuals, slopes);
  } else {
    run<false>(here, there, map, params, share, residuals, slopes);
  }
}

}  // namespace hypotrack::stereo_color::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_color {

HWY_EXPORT(write_slopes_covered);

void write_slopes(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                  const Params& params, float share, const PixelPlane<float>& uncovered,
                  std::span<float> residuals, std::span<float> slopes) {
  std::copy_n(uncovered.row(0), residuals.size(), residuals.data());
  std::fill(slopes.begin(), slopes.end(), 0.0f);
  HWY_DYNAMIC_DISPATCH(write_slopes_covered)
  (here, there, map, params, share, residuals.data(), slopes.data());
}

}  // namespace hypotrack::stereo_color
#endif
