#include "score.hpp"

#define HWY_TARGET_INCLUDE "score.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "coverage-inl.hpp"
#include "hypotrack/plugin/view_pixels-inl.hpp"

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
