#include <algorithm>

#include "score.hpp"

#define HWY_TARGET_INCLUDE "slopes.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "volume_lookup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

struct SlopeWriter {
  static constexpr bool kVisitsUncovered = false;
  static constexpr float kReach = 0.5f;  // planes to either side

  VolumeLookup volume;
  const PixelPlane<float>& weight;
  float* residuals;
  float* slopes;

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    const LaneMask counts = volume.counting(p);
    if (!any(counts)) return;
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(p.y) * weight.width() + p.x;
    const Lanes most = p.here(weight), zero(0.0f);
    const Lanes s = select(counts, volume.similarity(p, counts), zero);
    store(patch_residual(most, s), p.pixels, residuals + at);
    const Lanes near = patch_residual(most, volume.similarity_beside(p, counts, kReach));
    const Lanes far = patch_residual(most, volume.similarity_beside(p, counts, -kReach));
    const Lanes slope = (near - far) * volume.density() * Lanes(0.5f / kReach);
    store(select(counts, slope, zero), p.pixels, slopes + at);
  }
  HYPOTRACK_PIXEL void end_row() {}
};

void write_slopes_counting(const Volume& volume, const DepthTile& left, const DepthTile& right,
                           const StereoMap& map, float tolerance, float* residuals, float* slopes) {
  SlopeWriter writer{VolumeLookup(volume), volume.weight, residuals, slopes};
  for_each_stereo_pixel(left, right, map, tolerance, covered_box(left), writer);
}

}  // namespace hypotrack::stereo_patch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_patch {

HWY_EXPORT(write_slopes_counting);

void write_slopes(const Volume& volume, const DepthTile& left, const DepthTile& right,
                  const StereoMap& map, float tolerance, std::span<float> residuals,
                  std::span<float> slopes) {
  std::copy_n(volume.uncovered.row(0), residuals.size(), residuals.data());
  std::ranges::fill(slopes, 0.0f);
  HWY_DYNAMIC_DISPATCH(write_slopes_counting)
  (volume, left, right, map, tolerance, residuals.data(), slopes.data());
}

}  // namespace hypotrack::stereo_patch
#endif
