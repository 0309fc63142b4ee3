#include "color_model.hpp"

#include <Eigen/Core>

namespace hypotrack::skin {
namespace {

/// Smooths counts along one axis of the bins, twice with weights 1, 2, 1: with 1, 4, 6, 4, 1, and 5
/// for the first and the last level themselves, whose first share is lost beyond the end. `stride`
/// is the distance between neighbouring levels.
void spread_along(const std::vector<double>& counts, std::size_t stride, std::vector<double>& out) {
  constexpr Eigen::Index kInner = kLevels - 4, kLast = kLevels - 1;
  for (std::size_t first = 0; first < kBins; first += stride * kLevels) {
    const auto size = static_cast<Eigen::Index>(stride);
    const Eigen::Map<const Eigen::ArrayXXd> from(counts.data() + first, size, kLevels);
    Eigen::Map<Eigen::ArrayXXd> to(out.data() + first, size, kLevels);
    const auto inner = [&](Eigen::Index level) { return from.middleCols(level, kInner); };
    to.middleCols(2, kInner) = 6 * inner(2) + 4 * (inner(1) + inner(3)) + (inner(0) + inner(4));
    const auto spread_end = [&](Eigen::Index end, Eigen::Index inwards) {
      const auto level = [&](Eigen::Index i) { return from.col(end + i * inwards); };
      to.col(end) = 5 * level(0) + 4 * level(1) + level(2);
      to.col(end + inwards) = 6 * level(1) + 4 * (level(0) + level(2)) + level(3);
    };
    spread_end(0, 1);
    spread_end(kLast, -1);
  }
}

/// Counts that are smoothed, and what to multiply them by to get the frequencies of colours.
struct Smoothed {
  std::vector<double> counts;
  double share = 0;
};

Smoothed smooth(const std::vector<double>& counts) {
  constexpr std::size_t kRow = kLevels, kPlane = kRow * kLevels;
  Smoothed out{std::vector<double>(kBins)};
  std::vector<double> between(kBins);
  spread_along(counts, 1, out.counts);
  spread_along(out.counts, kRow, between);
  spread_along(between, kPlane, out.counts);
  const double sum = Eigen::Map<const Eigen::ArrayXd>(out.counts.data(), kBins).sum();
  out.share = sum > 0 ? 1 / sum : 0;
  return out;
}

/// Writes P of every bin.
void write_ratios(const std::vector<double>& foreground, const std::vector<double>& background,
                  std::vector<double>& ratios) {
  // Frequency of a colour, one in a million pixels, that says nothing.
  constexpr double kUnseen = 1e-6;
  const Smoothed f = smooth(foreground), b = smooth(background);
  for (std::size_t i = 0; i < kBins; ++i) {
    const double here = f.share * f.counts[i];
    ratios[i] = here / (here + b.share * b.counts[i] + kUnseen);
  }
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
    write_ratios(foreground, background, ratio_);
  }
  foreground_ = foreground;
  background_ = background;
}

std::vector<float> ColorModel::probabilities() const {
  if (ratio_.empty()) return std::vector<float>(kBins, 0.0f);
  return {ratio_.begin(), ratio_.end()};
}

std::vector<ColorFrequency> ColorModel::color_frequencies() const {
  const Smoothed f = smooth(foreground_), b = smooth(background_);
  std::vector<ColorFrequency> out(kBins);
  for (std::size_t i = 0; i < kBins; ++i)
    out[i] = {static_cast<float>(f.share * f.counts[i]), static_cast<float>(b.share * b.counts[i])};
  return out;
}

}  // namespace hypotrack::skin
