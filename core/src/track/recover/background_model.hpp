#pragma once

#include <opencv2/core/mat.hpp>

namespace hypotrack {

/// Learns the background of a still camera as a mean colour per pixel (Wren et al., "Pfinder:
/// real-time tracking of the human body", PAMI 1997). Pictures of a moving camera differ from it
/// everywhere, so the model then has no effect.
class BackgroundModel {
 public:
  /// Learns the pixels of a picture that are not in `foreground` (empty: all pixels).
  void learn(const cv::Mat3b& picture, const cv::Mat1b& foreground);

  /// Returns a weight per pixel: 1 where it differs from the background or nothing is known, near 0
  /// where it is the same.
  cv::Mat1f changed(const cv::Mat3b& picture) const;

 private:
  cv::Mat3f mean_;
  cv::Mat1b known_;
};

}  // namespace hypotrack
