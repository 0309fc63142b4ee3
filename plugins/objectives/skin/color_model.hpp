#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "color_bins.hpp"

namespace hypotrack::skin {

/// Estimates how likely a colour is foreground: P = f / (f + b), with f and b its frequencies among
/// the foreground and background pixels so far (Jones and Rehg, "Statistical color models with
/// application to skin detection", IJCV 2002, equal priors). Counts are smoothed over neighbouring
/// bins, so that few pixels suffice. A colour never seen counts as background: P is near 0.
class ColorModel {
 public:
  /// Learns from an image (8-bit BGR). `prior` (32-bit float, the image's size) is the foreground
  /// probability of each pixel by its place alone; negative: ignore the pixel. `weight` (likewise)
  /// is its weight as background. Expectation maximisation combines places and colours. So a prior
  /// may be wrong about many pixels, if it is right about most pixels of a colour.
  void add(const cv::Mat3b& color, const cv::Mat1f& prior, const cv::Mat1f& weight);

  /// Returns P of every bin; 0 before the first image.
  std::vector<float> probabilities() const;
  /// Returns the frequencies of every bin's colour.
  std::vector<ColorFrequency> color_frequencies() const;

 private:
  // Double precision, as counts grow with every image.
  Eigen::ArrayXd foreground_ = Eigen::ArrayXd::Zero(kBins);
  Eigen::ArrayXd background_ = Eigen::ArrayXd::Zero(kBins);
  Eigen::ArrayXf ratio_;  // P; empty before the first image
};

}  // namespace hypotrack::skin
