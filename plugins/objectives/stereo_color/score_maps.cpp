#include <algorithm>
#include <cmath>
#include <limits>

#include "score.hpp"

#define HWY_TARGET_INCLUDE "score_maps.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "color_lookup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_color::HWY_NAMESPACE {

template <bool kBilinear>
struct MapWriter {
  static constexpr bool kVisitsUncovered = false;

  const Features& left;
  const Features& right;
  SimilarityCurve<Lanes> curve;
  Lanes unknown;
  float* squares;
  float* consistency;
  int width;

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    const auto here = sample_here(left, p), there = sample_there<kBilinear>(right, p);
    const auto at = static_cast<std::ptrdiff_t>(p.y) * width + p.x;
    store(select(p.seen, squared_difference(here, there), unknown), p.pixels, squares + at);
    store(select(p.seen, color_consistency(here, there, curve), unknown), p.pixels,
          consistency + at);
  }
  HYPOTRACK_PIXEL void end_row() {}
};

template <bool kBilinear>
void run(const ScoredView& here, const ScoredView& there, const StereoMap& map,
         const Params& params, float* squares, float* consistency) {
  MapWriter<kBilinear> writer{here.features,
                              there.features,
                              similarity_curve(params),
                              Lanes(std::numeric_limits<float>::quiet_NaN()),
                              squares,
                              consistency,
                              here.tile.width};
  for_each_stereo_pixel(here.tile, there.tile, map, static_cast<float>(params.r),
                        covered_box(here.tile), writer);
}

void write_maps(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                const Params& params, float* squares, float* consistency) {
  return params.lookup == Lookup::bilinear
             ? run<true>(here, there, map, params, squares, consistency)
             : run<false>(here, there, map, params, squares, consistency);
}

}  // namespace hypotrack::stereo_color::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_color {

HWY_EXPORT(write_maps);

ScoreMaps score_maps(const ScoredView& here, const ScoredView& there, const StereoMap& map,
                     const Params& params) {
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  const cv::Size size(here.tile.width, here.tile.height);
  ScoreMaps maps{cv::Mat1f(size, unknown), cv::Mat1f(size, unknown)};
  HWY_DYNAMIC_DISPATCH(write_maps)
  (here, there, map, params, maps.difference[0], maps.consistency[0]);
  std::transform(maps.difference.begin(), maps.difference.end(), maps.difference.begin(),
                 [](float square) { return std::sqrt(square); });
  return maps;
}

cv::Mat1f weight_map(const Features& features) {
  constexpr float kUnit = 1.0f / 65535.0f;
  const PixelPlane<std::uint32_t>& words = features.channel_2_weight;
  cv::Mat1f map(words.height(), words.width());
  for (int y = 0; y < map.rows; ++y)
    std::transform(words.row(y), words.row(y) + map.cols, map[y],
                   [](std::uint32_t word) { return static_cast<float>(word >> 16) * kUnit; });
  return map;
}

}  // namespace hypotrack::stereo_color
#endif
