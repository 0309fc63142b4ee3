#include "color_model.hpp"

#include <numeric>

namespace hypotrack::skin {
namespace {

/// Smooths counts along one axis of the bins with weights 1, 2, 1.
std::vector<double> spread_along(const std::vector<double>& counts, std::size_t stride) {
  std::vector<double> out(kBins);
  for (std::size_t i = 0; i < kBins; ++i) {
    const std::size_t level = i / stride % kLevels;
    out[i] = 2 * counts[i];
    if (level > 0) out[i] += counts[i - stride];
    if (level + 1 < kLevels) out[i] += counts[i + stride];
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
  constexpr int kRounds = 12;  // it converges within a few
  const std::vector<Seen> pixels = seen_pixels(color, prior, weight);
  Counts foreground, background;
  std::vector<double> ratio(kBins, 0.5);
  for (int round = 0; round < kRounds; ++round) {
    foreground = foreground_;
    background = background_;
    for (const Seen& pixel : pixels) {
      const double f = ratio[pixel.bin] * pixel.prior;
      const double b = (1 - ratio[pixel.bin]) * (1 - pixel.prior);
      const double share = f + b > 0 ? f / (f + b) : 0;
      foreground[pixel.bin] += share;
      background[pixel.bin] += pixel.weight * (1 - share);
    }
    ratio = ratios(foreground, background);
  }
  foreground_ = foreground;
  background_ = background;
}

std::vector<float> ColorModel::probabilities() const {
  const std::vector<double> ratio = ratios(foreground_, background_);
  return {ratio.begin(), ratio.end()};
}

std::vector<ColorFrequency> ColorModel::color_frequencies() const {
  const std::vector<double> f = frequencies(foreground_), b = frequencies(background_);
  std::vector<ColorFrequency> out(kBins);
  for (std::size_t i = 0; i < kBins; ++i)
    out[i] = {static_cast<float>(f[i]), static_cast<float>(b[i])};
  return out;
}

}  // namespace hypotrack::skin
