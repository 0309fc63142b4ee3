#include "score.hpp"

#define HWY_TARGET_INCLUDE "score.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "volume_lookup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

struct PatchTerm {
  static constexpr bool kVisitsUncovered = false;

  VolumeLookup volume;
  LaneSum sum;

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    const LaneMask counts = volume.counting(p);
    if (any(counts)) sum.add(counts, volume.similarity(p, counts));
  }
  HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
};

double sum_on_target(const Volume& volume, const DepthTile& left, const DepthTile& right,
                     const StereoMap& map, float tolerance) {
  PatchTerm term{VolumeLookup(volume), {}};
  for_each_stereo_pixel(left, right, map, tolerance, covered_box(left), term);
  return term.sum.total();
}

}  // namespace hypotrack::stereo_patch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_patch {

HWY_EXPORT(sum_on_target);

double sum_similarity(const Volume& volume, const DepthTile& left, const DepthTile& right,
                      const StereoMap& map, float tolerance) {
  return HWY_DYNAMIC_DISPATCH(sum_on_target)(volume, left, right, map, tolerance);
}

std::int64_t score_targets() { return HWY_TARGETS; }

}  // namespace hypotrack::stereo_patch
#endif
