#include "score.hpp"

#define HWY_TARGET_INCLUDE "score.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "depth_agreement-inl.hpp"
#include "hypotrack/plugin/view_pixels-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::rgbd_depth::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes and the walk

struct DepthTerm {
  static constexpr bool kVisitsUncovered = false;

  const PixelPlane<float>& observed;
  Lanes d_max;
  Lanes d_match;
  LaneSum closeness;
  std::int64_t matched = 0;
  std::int64_t beyond = 0;

  HYPOTRACK_PIXEL void pixels(const ViewPixels& p) {
    const auto agreement = depth_agreement(p.inverse_depth, p.here(observed), d_max, d_match);
    closeness.add(p.covered, agreement.closeness);
    matched += count(p.covered && agreement.matched);
    beyond += count(p.covered && agreement.beyond);
  }
  HYPOTRACK_PIXEL void end_row() { closeness.end_row(); }
};

Agreement compare_on_target(const PixelPlane<float>& observed, const DepthTile& tile, float d_max,
                            float d_match) {
  DepthTerm term{observed, Lanes(d_max), Lanes(d_match), {}};
  for_each_view_pixel(tile, covered_box(tile), term);
  return {term.closeness.total(), term.matched, term.beyond};
}

}  // namespace hypotrack::rgbd_depth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::rgbd_depth {

HWY_EXPORT(compare_on_target);

Agreement compare(const PixelPlane<float>& observed, const DepthTile& tile, float d_max,
                  float d_match) {
  return HWY_DYNAMIC_DISPATCH(compare_on_target)(observed, tile, d_max, d_match);
}

std::int64_t compiled_targets() { return HWY_TARGETS; }

}  // namespace hypotrack::rgbd_depth
#endif
