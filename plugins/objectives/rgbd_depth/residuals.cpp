#include <algorithm>
#include <cmath>

#include "score.hpp"

#define HWY_TARGET_INCLUDE "residuals.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "depth_agreement-inl.hpp"
#include "hypotrack/plugin/view_pixels-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::rgbd_depth::HWY_NAMESPACE {

using namespace hypotrack::HWY_NAMESPACE;  // Lanes and the walk

struct ResidualWriter {
  static constexpr bool kVisitsUncovered = false;

  const PixelPlane<float>& observed;
  const PixelPlane<float>& uncovered;
  Lanes d_max;
  Lanes factor;
  float* out;

  HYPOTRACK_PIXEL void pixels(const ViewPixels& p) {
    const Lanes r = factor * depth_residual(p.inverse_depth, p.here(observed), d_max);
    store(select(p.covered, r, p.here(uncovered)), p.pixels,
          out + static_cast<std::ptrdiff_t>(p.y) * observed.width() + p.x);
  }
  HYPOTRACK_PIXEL void end_row() {}
};

void write_covered(const PixelPlane<float>& observed, const DepthTile& tile, float d_max,
                   float factor, const PixelPlane<float>& uncovered, float* out) {
  ResidualWriter writer{observed, uncovered, Lanes(d_max), Lanes(factor), out};
  for_each_view_pixel(tile, covered_box(tile), writer);
}

}  // namespace hypotrack::rgbd_depth::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::rgbd_depth {

HWY_EXPORT(write_covered);

PixelPlane<float> uncovered_residuals(const PixelPlane<float>& observed,
                                      const PixelPenalties& penalties) {
  PixelPlane<float> plane(observed.width(), observed.height());
  for (int y = 0; y < observed.height(); ++y) {
    std::transform(observed.row(y), observed.row(y) + observed.width(), plane.row(y),
                   [&](float o) { return uncovered_residual(o, penalties); });
  }
  return plane;
}

void write_residuals(const PixelPlane<float>& observed, const DepthTile& tile, float d_max,
                     const PixelPenalties& penalties, const PixelPlane<float>& uncovered,
                     std::span<float> residuals) {
  std::copy_n(uncovered.row(0), residuals.size(), residuals.data());
  HWY_DYNAMIC_DISPATCH(write_covered)
  (observed, tile, d_max, std::sqrt(penalties.wrong), uncovered, residuals.data());
}

}  // namespace hypotrack::rgbd_depth
#endif
