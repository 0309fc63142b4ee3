#include "color_model.hpp"

#include <Eigen/Core>
#include <numeric>

namespace hypotrack::skin {
namespace {

/// Smooths counts along one axis of the bins with weights 1, 2, 1. `stride` is the distance between
/// neighbouring levels.
std::vector<double> spread_along(const std::vector<double>& counts, std::size_t stride) {
  std::vector<double> out(kBins);
  constexpr Eigen::Index kOthers = kLevels - 1;
  for (std::size_t first = 0; first < kBins; first += stride * kLevels) {
    const auto size = static_cast<Eigen::Index>(stride);
    const Eigen::Map<const Eigen::ArrayXXd> from(counts.data() + first, size, kLevels);
    Eigen::Map<Eigen::ArrayXXd> to(out.data() + first, size, kLevels);
    to = 2 * from;
    to.rightCols(kOthers) += from.leftCols(kOthers);
    to.leftCols(kOthers) += from.rightCols(kOthers);
  }
  return out;
}

/// Returns the frequencies of colours: smoothed counts divided by their sum.
std::vector<double> frequencies(std::vector<double> out) {
  for (const std::size_t stride :
       {std::size_t{1}, std::size_t{kLevels}, std::size_t{kLevels} * kLevels}) {
    out = spread_along(spread_along(out, stride), stride);
  }
  const double sum = std::accumulate(out.begin(), out.end(), 0.0);
  for (double& value : out) value = sum > 0 ? value / sum : 0;
  return out;
}

/// Returns P of every bin.
std::vector<double> ratios(const std::vector<double>& foreground,
                           const std::vector<double>& background) {
  // Frequency of a colour, one in a million pixels, that says nothing.
  constexpr double kUnseen = 1e-6;
  std::vector<double> f = frequencies(foreground);
  const std::vector<double> b = frequencies(background);
  for (std::size_t i = 0; i < kBins; ++i) f[i] /= f[i] + b[i] + kUnseen;
  return f;
}

/// A pixel that counts.
struct Seen {
  std::size_t bin;
  double prior;
  double weight;  ///< as background
};

std::vector<Seen> seen_pixels(const cv::Mat3b& color, const cv::Mat1f& prior,
                              const cv::Mat1f& weight) {
  std::vector<Seen> out;
  out.reserve(color.total());
  for (int y = 0; y < color.rows; ++y) {
    for (int x = 0; x < color.cols; ++x) {
      const cv::Vec3b& p = color(y, x);
      if (!(prior(y, x) >= 0)) continue;
      out.push_back({static_cast<std::size_t>(bin_of(p[0], p[1], p[2])), double{prior(y, x)},
                     double{weight(y, x)}});
    }
  }
  return out;
}

}  // namespace

void ColorModel::add(const cv::Mat3b& color, const cv::Mat1f& prior, const cv::Mat1f& weight) {
  const int rounds = ratio_.empty() ? 12 : 5;  // it begins near the answer after the first image
  const std::vector<Seen> pixels = seen_pixels(color, prior, weight);
  if (ratio_.empty()) ratio_.assign(kBins, 0.5);
  for (double& ratio : ratio_) ratio = (ratio + 0.5) / 2;  // a colour may have changed sides
  Counts foreground, background;
  for (int round = 0; round < rounds; ++round) {
    foreground = foreground_;
    background = background_;
    for (const Seen& pixel : pixels) {
      const double f = ratio_[pixel.bin] * pixel.prior;
      const double b = (1 - ratio_[pixel.bin]) * (1 - pixel.prior);
      const double share = f + b > 0 ? f / (f + b) : 0;
      foreground[pixel.bin] += share;
      background[pixel.bin] += pixel.weight * (1 - share);
    }
    ratio_ = ratios(foreground, background);
  }
  foreground_ = foreground;
  background_ = background;
}

std::vector<float> ColorModel::probabilities() const {
  if (ratio_.empty()) return std::vector<float>(kBins, 0.0f);
  return {ratio_.begin(), ratio_.end()};
}

std::vector<ColorFrequency> ColorModel::color_frequencies() const {
  const std::vector<double> f = frequencies(foreground_), b = frequencies(background_);
  std::vector<ColorFrequency> out(kBins);
  for (std::size_t i = 0; i < kBins; ++i)
    out[i] = {static_cast<float>(f[i]), static_cast<float>(b[i])};
  return out;
}

}  // namespace hypotrack::skin
