#pragma once

#include <array>
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

  /// Returns whether any picture was learned.
  bool has_learned() const { return !steady_.empty(); }
  /// Returns the means of a part of the picture, with alpha 255 where they are known.
  cv::Mat4b background(const cv::Rect& part) const;

  /// Returns a weight per pixel: 1 where it differs from the background or nothing is known, near 0
  /// where it is the same.
  cv::Mat1f changed(const cv::Mat3b& picture) const;

 private:
  std::array<cv::Mat1s, 3> means_;  ///< of a channel, in units of BackgroundRow
  cv::Mat1b steady_;                ///< of BackgroundRow
};

}  // namespace internal
}  // namespace hypotrack
