#include "score.hpp"

#define HWY_TARGET_INCLUDE "score.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "color_lookup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_color::HWY_NAMESPACE {

template <bool kBilinear>
struct ColorTerm {
  static constexpr bool kVisitsUncovered = false;

  const Features& left;
  const Features& right;
  SimilarityCurve<Lanes> curve;
  LaneSum sum;
  std::int64_t seen = 0;
  std::int64_t rendered = 0;

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    rendered += count(p.seen || p.occluded);
    if (!any(p.seen)) return;
    seen += count(p.seen);
    sum.add(p.seen,
            color_consistency(sample_here(left, p), sample_there<kBilinear>(right, p), curve));
  }
  HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
};

template <bool kBilinear>
Similarity run(const ScoredView& here, const ScoredView& there, const StereoMap& map,
               const Params& params) {
  ColorTerm<kBilinear> term{here.features, there.features, similarity_curve(params), {}};
  for_each_stereo_pixel(here.tile, there.tile, map, static_cast<float>(params.r),
                        covered_box(here.tile), term);
  return {term.sum.total(), term.seen, term.rendered};
}

Similarity measure_on_target(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                             const Params& params) {
  return params.lookup == Lookup::bilinear ? run<true>(here, there, map, params)
                                           : run<false>(here, there, map, params);
}

}  // namespace hypotrack::stereo_color::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_color {

HWY_EXPORT(measure_on_target);

Similarity measure(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                   const Params& params) {
  return HWY_DYNAMIC_DISPATCH(measure_on_target)(here, there, map, params);
}

std::int64_t compiled_targets() { return HWY_TARGETS; }

}  // namespace hypotrack::stereo_color
#endif
