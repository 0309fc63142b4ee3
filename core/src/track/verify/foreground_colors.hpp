#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "track/verify/surface_samples.hpp"

namespace hypotrack {

/// Learns how likely a colour belongs to a model, from frames where the model's pose is surely
/// right. P = f / (f + b), with f and b the frequencies of the colour on the model and beside it.
/// Source: Jones and Rehg, "Statistical color models with application to skin detection", IJCV
/// 2002, equal priors.
class ForegroundColors {
 public:
  /// Learns from samples of a model whose pose is surely right. Older frames fade.
  void learn(const SurfaceSamples& samples);
  bool known() const { return !probability_.empty(); }
  /// Returns P of a colour (B, G, R, 0 .. 255); 0.5 before anything was learned.
  float probability(const cv::Vec3f& color) const;

 private:
  std::vector<float> foreground_, background_, probability_;
};

}  // namespace hypotrack
