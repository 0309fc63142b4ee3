#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "track/verify/surface_samples.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Knows how likely a colour belongs to a model, from frames where the model's pose is surely
/// right. P = f / (f + b), with f and b the frequencies of the colour on the model and beside it.
/// Source: Jones and Rehg, "Statistical color models with application to skin detection", IJCV
/// 2002, equal priors.
class ForegroundColors {
 public:
  /// Learns from samples of a model whose pose is surely right. Older frames fade.
  void learn(const SurfaceSamples& samples);
  /// Expects a surface of these colours (B, G, R, 0 .. 255) in light of any brightness, before a
  /// background of all that pictures show. Replaces what was learned.
  void expect(std::span<const cv::Vec3f> surface, std::span<const cv::Mat3b> pictures);
  bool known() const { return !probability_.empty(); }
  /// Returns P of a colour (B, G, R, 0 .. 255); 0.5 before anything was learned.
  float probability(const cv::Vec3f& color) const;

 private:
  void update();

  std::vector<float> foreground_, background_, probability_;
};

}  // namespace internal
}  // namespace hypotrack
