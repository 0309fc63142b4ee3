#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"
#include "track/verify/surface_samples.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Learns the colours of a model's surface points and compares later frames with them. A box that
/// is turned or shifted agrees between the views, but not with its own earlier picture.
class Appearance {
 public:
  /// Takes the colours of all points as seen once.
  void expect(const std::vector<cv::Vec3f>& colors);

  /// Updates the running mean colour of every point that the samples show. Older colours fade.
  void learn(const SurfaceSamples& samples);

  /// Returns the correlation (-1 .. 1) of the present with the learned colours, the best over small
  /// image shifts. It is about 0 for a surface of one colour. NaN if too few visible points were
  /// seen before.
  double likeness(const SurfaceSamples& samples) const;

 private:
  std::vector<Eigen::Array4f> colors_;  ///< B, G, R and 0
  std::vector<float> times_;            ///< frames in which each point was seen
};

}  // namespace internal
}  // namespace hypotrack
