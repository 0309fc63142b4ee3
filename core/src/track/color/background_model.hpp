#pragma once

#include <opencv2/core/mat.hpp>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Learns what each pixel of a still camera shows without the models. A mean colour is known where
/// the last pictures agreed with it, so nothing is known of a moving camera. Source: Wren et al.,
/// "Pfinder: real-time tracking of the human body", PAMI 1997.
class BackgroundModel {
 public:
  /// Learns the pixels of a picture that are not in `models` (empty: all).
  void learn(const cv::Mat3b& picture, const cv::Mat1b& models);

  /// Returns the means, with alpha 255 where they are known; empty before the first picture.
  const cv::Mat4b& background() const { return background_; }

  /// Returns a weight per pixel: 1 where it differs from the background or nothing is known, near 0
  /// where it is the same.
  cv::Mat1f changed(const cv::Mat3b& picture) const;

 private:
  cv::Mat3f mean_;
  cv::Mat1b steady_;  ///< 0 .. 255: how well the last pictures agreed with the mean
  cv::Mat4b background_;
};

}  // namespace internal
}  // namespace hypotrack
