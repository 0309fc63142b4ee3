#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "color_bins.hpp"

namespace hypotrack::skin {

/// How likely a colour is foreground: P = f / (f + b), f and b its frequencies among the foreground
/// and the background pixels seen so far (Jones and Rehg, "Statistical color models with
/// application to skin detection", IJCV 2002, with equal priors). Counts are spread over
/// neighbouring bins, as noise spreads colours, so that few pixels suffice; a colour that was never
/// seen is background for all that is known: P near 0.
class ColorModel {
 public:
  /// Learns from an image (8-bit BGR). `prior` (32-bit float, its size) says how likely each pixel
  /// is foreground by its place alone; negative: the pixel does not count. `weight` (likewise) is
  /// how much it counts as background. Places and colours are weighed against each other by
  /// expectation maximisation, so that a prior may be wrong about many pixels as long as it is
  /// right about most of a colour's.
  void add(const cv::Mat3b& color, const cv::Mat1f& prior, const cv::Mat1f& weight);

  /// P of every bin.
  std::vector<float> probabilities() const;

 private:
  using Counts = std::vector<double>;
  Counts foreground_ = Counts(kBins);
  Counts background_ = Counts(kBins);
};

}  // namespace hypotrack::skin
