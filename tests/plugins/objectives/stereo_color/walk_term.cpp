// The header guide's functor in full: what an objective outside the project would write.
#include "walk_term.hpp"

#define HWY_TARGET_INCLUDE "walk_term.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "hypotrack/plugin/stereo_pixels-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_color::HWY_NAMESPACE {
namespace {

using namespace hypotrack::HWY_NAMESPACE;

struct Counter {
  static constexpr bool kVisitsUncovered = true;
  const PixelPlane<float>& here_feature;
  const PixelPlane<float>& there_feature;
  LaneSum here, there;
  WalkCounts counts;

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    counts.seen += count(p.seen);
    counts.occluded += count(p.occluded);
    counts.uncovered += count(p.uncovered);
    counts.overlaps += count((p.seen && p.occluded) || ((p.seen || p.occluded) && p.uncovered));
    here.add(p.seen || p.occluded, p.here(here_feature));
    there.add(p.seen, p.nearest(there_feature));
  }
  HYPOTRACK_PIXEL void end_row() {
    here.end_row();
    there.end_row();
  }
};

WalkCounts walk_on_target(const DepthTile& here, const DepthTile& there, const StereoMap& map,
                          const PixelBox& region, const PixelPlane<float>& here_feature,
                          const PixelPlane<float>& there_feature) {
  Counter counter{here_feature, there_feature, {}, {}, {}};
  for_each_stereo_pixel(here, there, map, 0.003f, region, counter);
  counter.counts.here = counter.here.total();
  counter.counts.there = counter.there.total();
  return counter.counts;
}

}  // namespace
}  // namespace hypotrack::stereo_color::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_color {
HWY_EXPORT(walk_on_target);
WalkCounts walk(const DepthTile& here, const DepthTile& there, const StereoMap& map,
                const PixelBox& region, const PixelPlane<float>& here_feature,
                const PixelPlane<float>& there_feature) {
  return HWY_DYNAMIC_DISPATCH(walk_on_target)(here, there, map, region, here_feature,
                                              there_feature);
}
}  // namespace hypotrack::stereo_color
#endif
