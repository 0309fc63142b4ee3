#pragma once

#include <memory>

#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/view_pixels.hpp"
#include "params.hpp"
#include "volume.hpp"

namespace hypotrack::stereo_patch {

/// Patch consistency of a hypothesis in a stereo pair. Like stereo_color, but compares patches of
/// grey around the two pixels that see a surface point. The measure is invariant to brightness and
/// contrast of one view against the other. A uniform surface, which is consistent in colour
/// wherever it is put, scores almost nothing.
///
///   z = cov(a, b) / sqrt((var a + e)(var b + e))     patches a (left) and b (right), e the floor
///   s = exp(-sharpness (1 - z))
///   S = sum of s over the pixels of the left view that the hypothesis covers and whose surface
///       point the right view sees too (within r of the depth rendered there),   cost = -S
///
/// (or z by census: patch_compare-inl.hpp). Patches are compared as if every surface were parallel
/// to the left view's image plane. So the comparison needs no hypothesis: `prepare` fills a volume
/// with s of every pixel at a range of depths (volume.hpp). Scoring a pixel is one lookup,
/// interpolated in depth. In a rectified pair the volume is over disparities; other pairs are
/// resampled by the general projection.
///
/// With full_at_difference, s is multiplied by a weight c in 0..1 of the frame (share_of());
/// otherwise c is 1.
///
/// A hypothesis without a pixel that both views see costs 0, the worst cost.
///
/// The cost is a sum of squares, up to a constant of the frame. Every pixel of the left tile within
/// the image and the mask, covered or not, has the residual sqrt(c - s). s is 0 unless both views
/// see its surface.
class StereoPatch : public Objective, public ResidualTerm {
 public:
  using Params = stereo_patch::Params;

  explicit StereoPatch(const Params& params);

 private:
  ImageUse do_image_use() const override;
  /// Uses the first two views. Throws DataError if there are fewer, on tiles under 2x2 pixels, and
  /// on images without their tile's size and type.
  void do_prepare(const Observation& observation) override;
  /// Throws DataError if the drawn tiles are not those of the prepared frame.
  double do_cost(const RenderedHypothesis& hypothesis) const override;
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override;

  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override;
  /// Writes the residuals. Throws DataError as cost() does, like cost_and_residuals().
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override;
  double do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const override;
  bool do_has_slopes() const override { return true; }
  std::span<const int> do_pixel_views() const override;
  /// Throws DataError as cost() does.
  void do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                       std::span<float> residuals, std::span<float> slopes) const override;

  void check_tiles(const RenderedHypothesis& hypothesis) const;

  Params params_;
  StereoMap map_{};
  Volume volume_;
};

}  // namespace hypotrack::stereo_patch
