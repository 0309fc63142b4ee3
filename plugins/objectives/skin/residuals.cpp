#include <algorithm>

#include "score.hpp"
#include "uncovered_residual.hpp"

#define HWY_TARGET_INCLUDE "residuals.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "coverage-inl.hpp"
#include "hypotrack/plugin/view_pixels-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::skin::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes and the walk

struct ResidualWriter {
  static constexpr bool kVisitsUncovered = false;

  const PixelPlane<std::uint32_t>& foreground;
  const PixelPlane<float>& uncovered;
  Lanes spill, share;
  float* out;
  LaneSum sum;

  HYPOTRACK_PIXEL void pixels(const ViewPixels& p) {
    const WordLanes here = p.here(foreground);
    const Lanes background = unorm16_high(here);
    sum.add(p.covered, change_if_covered(unorm16_low(here), background, spill));
    const Lanes r = covered_residual(background, spill, share);
    store(select(p.covered, r, p.here(uncovered)), p.pixels,
          out + static_cast<std::ptrdiff_t>(p.y) * foreground.width() + p.x);
  }
  HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
};

double write_covered(const PixelPlane<std::uint32_t>& foreground, const DepthTile& tile,
                     float spill, float share, const PixelPlane<float>& uncovered, float* out) {
  ResidualWriter writer{foreground, uncovered, Lanes(spill), Lanes(share), out, {}};
  for_each_view_pixel(tile, covered_box(tile), writer);
  return writer.sum.total();
}

}  // namespace hypotrack::skin::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::skin {

HWY_EXPORT(write_covered);

PixelPlane<float> uncovered_residuals(const PixelPlane<std::uint32_t>& foreground, float share) {
  constexpr float kUnit = 1.0f / 65535.0f;
  PixelPlane<float> plane(foreground.width(), foreground.height());
  for (int y = 0; y < plane.height(); ++y) {
    std::transform(foreground.row(y), foreground.row(y) + plane.width(), plane.row(y),
                   [&](std::uint32_t word) {
                     return uncovered_residual(static_cast<float>(word & 0xFFFF) * kUnit, share);
                   });
  }
  return plane;
}

double write_residuals(const PixelPlane<std::uint32_t>& foreground, const DepthTile& tile,
                       float spill, float share, const PixelPlane<float>& uncovered,
                       std::span<float> residuals) {
  std::copy_n(uncovered.row(0), residuals.size(), residuals.data());
  return HWY_DYNAMIC_DISPATCH(write_covered)(foreground, tile, spill, share, uncovered,
                                             residuals.data());
}

}  // namespace hypotrack::skin
#endif
