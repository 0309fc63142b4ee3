#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <opencv2/core/matx.hpp>
#include <span>

namespace hypotrack::contour {

/// Colours on a model and beside it in one view, as histograms of 16 x 16 x 16 bins.
class ColorHistograms {
 public:
  /// Counts a colour of the current frame.
  void count(const cv::Vec3b& color, bool on_model) {
    Side& side = on_model ? on_ : beside_;
    ++side.counts[static_cast<Eigen::Index>(bin_of(color))];
    ++side.sum;
  }
  /// Mixes the counts, as shares, into the histograms with a weight and begins new counts. Without
  /// counts on both sides nothing changes.
  void learn(double weight);
  /// Begins new counts.
  void discard();

  bool is_empty() const { return log_odds_.size() == 0; }
  /// Returns the log odds that a pixel is the model's, by bin; 0 for colours never seen.
  std::span<const float> log_odds() const {
    return {log_odds_.data(), log_odds_.data() + log_odds_.size()};
  }
  /// Returns a colour's bin: the upper four bits of each channel, blue first.
  static std::size_t bin_of(const cv::Vec3b& color) {
    return static_cast<std::size_t>((color[0] >> 4) << 8 | (color[1] >> 4) << 4 | color[2] >> 4);
  }

 private:
  static constexpr Eigen::Index kBins = 4096;

  struct Side {
    Eigen::ArrayXf shares = Eigen::ArrayXf::Zero(kBins);
    Eigen::ArrayXi counts = Eigen::ArrayXi::Zero(kBins);
    int sum = 0;
    void mix(float weight);
  };

  Side on_, beside_;
  Eigen::ArrayXf log_odds_;  ///< by bin; empty before learn()
};

}  // namespace hypotrack::contour
