#include <algorithm>

#include "score.hpp"

#define HWY_TARGET_INCLUDE "residuals.cpp"
#include <hypotrack/plugin/foreach_target-inl.hpp>

#include "volume_lookup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace hypotrack::stereo_patch::HWY_NAMESPACE {

struct ResidualWriter {
  static constexpr bool kVisitsUncovered = false;

  VolumeLookup volume;
  const PixelPlane<float>& weight;
  float* out;
  LaneSum sum;

  HYPOTRACK_PIXEL void pixels(const StereoPixels& p) {
    const LaneMask counts = volume.counting(p);
    if (!any(counts)) return;
    const Lanes s = select(counts, volume.similarity(p, counts), Lanes(0.0f));
    sum.add(counts, s);
    store(patch_residual(p.here(weight), s), p.pixels,
          out + static_cast<std::ptrdiff_t>(p.y) * weight.width() + p.x);
  }
  HYPOTRACK_PIXEL void end_row() { sum.end_row(); }
};

double write_counting(const Volume& volume, const DepthTile& left, const DepthTile& right,
                      const StereoMap& map, float tolerance, float* out) {
  ResidualWriter writer{VolumeLookup(volume), volume.weight, out, {}};
  for_each_stereo_pixel(left, right, map, tolerance, covered_box(left), writer);
  return writer.sum.total();
}

}  // namespace hypotrack::stereo_patch::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hypotrack::stereo_patch {

HWY_EXPORT(write_counting);

double write_residuals(const Volume& volume, const DepthTile& left, const DepthTile& right,
                       const StereoMap& map, float tolerance, std::span<float> residuals) {
  std::copy_n(volume.uncovered.row(0), residuals.size(), residuals.data());
  return HWY_DYNAMIC_DISPATCH(write_counting)(volume, left, right, map, tolerance,
                                              residuals.data());
}

}  // namespace hypotrack::stereo_patch
#endif
