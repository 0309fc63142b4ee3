#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace hypotrack::contour {

/// Colours on a model and beside it in one view, as histograms of 16 x 16 x 16 bins.
class ColorHistograms {
 public:
  /// Counts a colour of the current frame.
  void count(const cv::Vec3b& color, bool on_model) {
    ++(on_model ? on_ : beside_).counts[bin_of(color)];
    ++(on_model ? on_ : beside_).sum;
  }
  /// Mixes the counts, as shares, into the histograms with a weight and begins new counts. Without
  /// counts on both sides nothing changes.
  void learn(double weight);
  /// Begins new counts.
  void discard();

  bool is_empty() const { return log_odds_.empty(); }
  /// Returns the log odds that each pixel of an image (8-bit BGR) is the model's; 0 where `valid`
  /// is 0.
  cv::Mat1f log_odds(const cv::Mat3b& color, const cv::Mat1b& valid) const;

 private:
  static constexpr int kShift = 4;  // bits of a channel that a bin leaves out
  static constexpr std::size_t kBins = 4096;

  static std::size_t bin_of(const cv::Vec3b& color) {
    return static_cast<std::size_t>((color[0] >> kShift) << 8 | (color[1] >> kShift) << 4 |
                                    color[2] >> kShift);
  }

  struct Side {
    std::vector<float> shares = std::vector<float>(kBins, 0.0f);
    std::vector<int> counts = std::vector<int>(kBins, 0);
    int sum = 0;
    void mix(float weight);
  };

  Side on_, beside_;
  std::vector<float> log_odds_;  ///< by bin; empty before learn()
};

}  // namespace hypotrack::contour
