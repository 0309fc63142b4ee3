#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "hand_detection.hpp"
#include "network.hpp"
#include "region.hpp"

namespace hypotrack::hands {

/// Finds the landmarks of a hand in a region of a picture by MediaPipe's hand landmark network.
class HandLandmarker {
 public:
  /// Reads the network. Throws DataError as Network does.
  explicit HandLandmarker(const std::filesystem::path& file);

  /// Returns the hand of a region of an 8-bit BGR picture; its palm's score is 1. The region
  /// follows the landmarks for up to `rounds` runs of the network, until it stays where it is.
  HandDetection find(const cv::Mat& picture, Region region, int rounds);

 private:
  HandDetection find_once(const cv::Mat& picture, const Region& region);

  Network network_;
};

}  // namespace hypotrack::hands
