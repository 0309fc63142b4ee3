#pragma once

#include <opencv2/core/mat.hpp>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Remembers what a still camera sees behind the models: a mean colour of each pixel (Wren et al.,
/// "Pfinder: real-time tracking of the human body", PAMI 1997). Pictures of a moving camera differ
/// from it, and so say nothing.
class HYPOTRACK_API BackgroundModel {
 public:
  /// Learns the pixels of a picture that are not in `foreground` (empty: none is).
  void learn(const cv::Mat3b& picture, const cv::Mat1b& foreground);

  /// Weighs the pixels of a picture: 1 where it differs from the background, or nothing is known;
  /// near 0 where it is the same.
  cv::Mat1f changed(const cv::Mat3b& picture) const;

 private:
  cv::Mat3f mean_;
  cv::Mat1b known_;
};

}  // namespace hypotrack
