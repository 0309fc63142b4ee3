#include "score.hpp"

// Too little between neighbours to be worth compiling all of them; the scalable ones do not fit
// simd-inl.hpp.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "score.cpp"
#include <hwy/foreach_target.h>

#include "coverage-inl.hpp"
#include "hypotrack/view_pixels-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::skin::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes and the walk

struct SkinTerm {
  static constexpr bool kVisitsUncovered = false;

  const PixelPlane<std::uint32_t>& foreground;
  Lanes spill;
  LaneSum sum;

  HYPOTRACK_PIXEL void pixels(const ViewPixels& p) {
    const WordLanes here = p.here(foreground);
    sum.add(p.covered, change_if_covered(unorm16_low(here), unorm16_high(here), spill));
  }
  HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
};

double sum_on_target(const PixelPlane<std::uint32_t>& foreground, const DepthTile& tile,
                     float spill) {
  SkinTerm term{foreground, Lanes(spill), {}};
  for_each_view_pixel(tile, covered_box(tile), term);
  return term.sum.total();
}

}  // namespace hypotrack::skin::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::skin {

HWY_EXPORT(sum_on_target);

double sum_covered(const PixelPlane<std::uint32_t>& foreground, const DepthTile& tile,
                   float spill) {
  return HWY_DYNAMIC_DISPATCH(sum_on_target)(foreground, tile, spill);
}

std::int64_t compiled_targets() { return HWY_TARGETS; }

}  // namespace hypotrack::skin
#endif
