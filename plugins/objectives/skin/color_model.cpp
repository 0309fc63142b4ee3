#include "color_model.hpp"

namespace hypotrack::skin {
namespace {

/// Numbers of all bins. Single precision, as smoothing takes most of the time.
using Bins = Eigen::ArrayXf;

/// Smooths counts along one axis of the bins, twice with weights 1, 2, 1: with 1, 4, 6, 4, 1, and 5
/// for the first and the last level themselves, whose first share is lost beyond the end. `stride`
/// is the distance between neighbouring levels.
void spread_along(const Bins& counts, Eigen::Index stride, Bins& out) {
  const Eigen::Index inner = counts.size() - 4 * stride;
  const auto from = [&](Eigen::Index levels) { return counts.segment(levels * stride, inner); };
  // In one go as if neighbouring rows were one, as rows are short. Their ends follow.
  out.segment(2 * stride, inner) = 6 * from(2) + 4 * (from(1) + from(3)) + (from(0) + from(4));
  constexpr Eigen::Index kLast = kLevels - 1;
  using Planes = Eigen::OuterStride<>;
  const auto spread_end = [&](Eigen::Index end, Eigen::Index inwards) {
    const Eigen::Index rows = counts.size() / (stride * kLevels);
    const auto level = [&](Eigen::Index i) {
      return Eigen::Map<const Eigen::ArrayXXf, 0, Planes>(
          counts.data() + (end + i * inwards) * stride, stride, rows, Planes(stride * kLevels));
    };
    const auto to = [&](Eigen::Index i) {
      return Eigen::Map<Eigen::ArrayXXf, 0, Planes>(out.data() + (end + i * inwards) * stride,
                                                    stride, rows, Planes(stride * kLevels));
    };
    to(0) = 5 * level(0) + 4 * level(1) + level(2);
    to(1) = 6 * level(1) + 4 * (level(0) + level(2)) + level(3);
  };
  spread_end(0, 1);
  spread_end(kLast, -1);
}

/// Returns the frequencies of colours by their counts, which are smoothed.
Bins frequencies(const Eigen::ArrayXd& counts) {
  constexpr Eigen::Index kRow = kLevels, kPlane = kRow * kLevels;
  Bins out = counts.cast<float>(), between(counts.size());
  spread_along(out, 1, between);
  spread_along(between, kRow, out);
  spread_along(out, kPlane, between);
  const float sum = between.sum();
  return sum > 0 ? Bins(between / sum) : between;
}

/// Returns P of every bin.
Bins ratios(const Eigen::ArrayXd& foreground, const Eigen::ArrayXd& background) {
  // Frequency of a colour, one in a million pixels, that says nothing.
  constexpr float kUnseen = 1e-6f;
  const Bins f = frequencies(foreground), b = frequencies(background);
  return f / (f + b + kUnseen);
}

/// A pixel that counts.
struct Seen {
  Eigen::Index bin;
  float prior;
  float weight;  ///< as background
};

std::vector<Seen> seen_pixels(const cv::Mat3b& color, const cv::Mat1f& prior,
                              const cv::Mat1f& weight) {
  std::vector<Seen> out;
  out.reserve(color.total());
  for (int y = 0; y < color.rows; ++y) {
    for (int x = 0; x < color.cols; ++x) {
      const cv::Vec3b& p = color(y, x);
      if (!(prior(y, x) >= 0)) continue;
      out.push_back({bin_of(p[0], p[1], p[2]), prior(y, x), weight(y, x)});
    }
  }
  return out;
}

}  // namespace

void ColorModel::add(const cv::Mat3b& color, const cv::Mat1f& prior, const cv::Mat1f& weight) {
  const int rounds = ratio_.size() == 0 ? 12 : 5;  // begins near the answer after the first image
  const std::vector<Seen> pixels = seen_pixels(color, prior, weight);
  if (ratio_.size() == 0) ratio_ = Bins::Constant(kBins, 0.5f);
  ratio_ = (ratio_ + 0.5f) / 2;  // a colour may have changed sides
  Eigen::ArrayXd foreground, background;
  for (int round = 0; round < rounds; ++round) {
    foreground = foreground_;
    background = background_;
    for (const Seen& pixel : pixels) {
      const float f = ratio_[pixel.bin] * pixel.prior;
      const float b = (1 - ratio_[pixel.bin]) * (1 - pixel.prior);
      const float share = f + b > 0 ? f / (f + b) : 0;
      foreground[pixel.bin] += double{share};
      background[pixel.bin] += double{pixel.weight * (1 - share)};
    }
    ratio_ = ratios(foreground, background);
  }
  foreground_ = foreground;
  background_ = background;
}

std::vector<float> ColorModel::probabilities() const {
  if (ratio_.size() == 0) return std::vector<float>(kBins, 0.0f);
  return {ratio_.begin(), ratio_.end()};
}

std::vector<ColorFrequency> ColorModel::color_frequencies() const {
  const Bins f = frequencies(foreground_), b = frequencies(background_);
  std::vector<ColorFrequency> out;
  for (Eigen::Index i = 0; i < f.size(); ++i) out.push_back({f[i], b[i]});
  return out;
}

}  // namespace hypotrack::skin
