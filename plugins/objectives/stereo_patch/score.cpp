#include "score.hpp"

// Too little between neighbours to be worth compiling all of them; the scalable ones do not fit
// simd-inl.hpp.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "score.cpp"
#include <hwy/foreach_target.h>

#include "hypotrack/stereo_pixels-inl.hpp"
#include "patch_similarity-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes and the walk

struct PatchTerm {
  static constexpr bool kVisitsUncovered = false;

  const Volume& volume;
  Lanes first, planes_per_unit, last;
  LaneSum sum;

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    const Lanes position = (p.inverse_depth - first) * planes_per_unit;
    const LaneMask counts = p.seen && between_planes(position, last);
    if (!any(counts)) return;
    const auto at = plane_share(select(counts, position, Lanes(0.0f)), last);
    const IntLanes index =
        to_int(at.before) * int_lanes(volume.width) + to_int(count_from(static_cast<float>(p.x)));
    const WordLanes pair = gather(volume.row(p.y), index);
    const Lanes before = unorm16_low(pair), after = unorm16_high(pair);
    sum.add(counts, mul_add(after - before, at.share, before));
  }
  HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
};

double sum_on_target(const Volume& volume, const DepthTile& left, const DepthTile& right,
                     const StereoMap& map, float tolerance) {
  const Planes& planes = volume.planes;
  PatchTerm term{volume,
                 Lanes(planes.first),
                 Lanes(1.0f / planes.step),
                 Lanes(static_cast<float>(planes.count - 1)),
                 {}};
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
