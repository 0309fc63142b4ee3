#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/export.hpp"
#include "track/judge/surface_samples.hpp"

namespace hypotrack {

/// Remembers what colours the points of a model's surface had where it was surely right: a turned
/// or shifted box agrees between the views, but not with its own picture.
class HYPOTRACK_API Appearance {
 public:
  /// Remembers the points that samples show. Older colours fade.
  void learn(const SurfaceSamples& samples);

  /// Correlation (-1 .. 1) of the colours that the points have and had, around their means: the
  /// best of some shifts. About 0 for surfaces of one colour; NaN for a side that was hardly seen
  /// before.
  double likeness(const SurfaceSamples& samples) const;

 private:
  std::vector<cv::Vec3f> colors_;
  std::vector<float> times_;  ///< that a point was seen
};

}  // namespace hypotrack
