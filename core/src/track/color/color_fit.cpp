#include "track/color/color_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kFewest = 100;       // samples
constexpr float kDark = 4, kBright = 251;  // beyond, a camera may have cut off
constexpr double kFlat = 8;                // standard deviation of the deciles, of 255
constexpr double kLargestScatter = 0.2;    // of the median
constexpr double kSmallestGain = 0.4, kLargestGain = 2.5, kLargestOffset = 60;
constexpr int kDeciles = 9;
constexpr double kTrim = 4;  // times the median distance: 2.7 standard deviations
constexpr int kPasses = 2;

/// Histogram of values 0 .. 255, for quantiles without sorting.
class Histogram {
 public:
  void add(float value) {
    const auto bin = static_cast<int>(value * kBinsPerLevel);
    ++bins_[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))];
    ++count_;
  }
  /// Returns the quantiles of given shares, which must increase. Interpolates within bins.
  template <std::size_t N>
  std::array<double, N> quantiles(const std::array<double, N>& shares) const {
    std::array<double, N> out{};
    std::size_t bin = 0;
    double below = 0;
    for (std::size_t i = 0; i < N; ++i) {
      const double wanted = shares[i] * count_;
      while (bin + 1 < kBins && below + bins_[bin] < wanted) below += bins_[bin++];
      const double within = bins_[bin] > 0 ? (wanted - below) / bins_[bin] : 0;
      out[i] = (static_cast<double>(bin) + within) / kBinsPerLevel;
    }
    return out;
  }
  double median() const { return quantiles(std::array{0.5})[0]; }

 private:
  static constexpr int kBinsPerLevel = 2;
  static constexpr int kBins = 256 * kBinsPerLevel;
  std::array<int, kBins> bins_{};
  int count_ = 0;
};

struct Line {
  double gain, offset;

  double distance(float first, float other) const {
    return std::abs(double{first} - gain * double{other} - offset);
  }
};

/// Fits a line through the deciles of both views by least squares. A prior pulls the gain to the
/// ratio of the means with the weight of deciles that differ by kFlat.
Line fit_line(const Histogram& first, const Histogram& other) {
  std::array<double, kDeciles> shares{};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    shares[i] = static_cast<double>(i + 1) / (kDeciles + 1);
  }
  const auto to = first.quantiles(shares), from = other.quantiles(shares);
  double to_mean = 0, from_mean = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    to_mean += to[i] / kDeciles;
    from_mean += from[i] / kDeciles;
  }
  double product = kDeciles * kFlat * kFlat * to_mean / from_mean;
  double square = kDeciles * kFlat * kFlat;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    product += (from[i] - from_mean) * (to[i] - to_mean);
    square += (from[i] - from_mean) * (from[i] - from_mean);
  }
  const double gain = product / square;
  return {gain, to_mean - gain * from_mean};
}

/// Pairs of one channel, without dark or saturated ones.
struct Pairs {
  Pairs(const std::vector<float>& a, const std::vector<float>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (std::min(a[i], b[i]) < kDark || std::max(a[i], b[i]) > kBright) continue;
      first.push_back(a[i]);
      other.push_back(b[i]);
    }
  }

  /// Fits a line to the pairs that lie within a distance of another line.
  Line fit(const Line& line, double distance) const {
    Histogram a, b;
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (line.distance(first[i], other[i]) > distance) continue;
      a.add(first[i]);
      b.add(other[i]);
    }
    return fit_line(a, b);
  }
  double median_distance(const Line& line) const {
    Histogram distances;
    for (std::size_t i = 0; i < first.size(); ++i) {
      distances.add(static_cast<float>(line.distance(first[i], other[i])));
    }
    return distances.median();
  }
  double level() const {
    Histogram levels;
    for (const float value : first) levels.add(value);
    return levels.median();
  }

  std::vector<float> first, other;
};

std::optional<Line> fit_channel(const Pairs& pairs) {
  if (pairs.first.size() < kFewest) return std::nullopt;
  Line line = pairs.fit({1, 0}, 256);  // all of them
  for (int pass = 0; pass < kPasses; ++pass) {
    line = pairs.fit(line, kTrim * pairs.median_distance(line) + 1);
  }
  if (!(line.gain >= kSmallestGain && line.gain <= kLargestGain)) return std::nullopt;
  if (!(std::abs(line.offset) <= kLargestOffset)) return std::nullopt;
  if (pairs.median_distance(line) > kLargestScatter * pairs.level()) return std::nullopt;
  return line;
}

}  // namespace

std::optional<ColorMap> fit_color_map(const ColorSamples& samples) {
  ColorMap map;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto line = fit_channel(Pairs(samples.first[i], samples.other[i]));
    if (!line) return std::nullopt;
    map.gain[i] = static_cast<float>(line->gain);
    map.offset[i] = static_cast<float>(line->offset);
  }
  return map;
}

double correlation(const ColorSamples& samples) {
  const auto size = static_cast<Eigen::Index>(samples.size());
  if (size == 0) return 0;
  double sum = 0;
  int varying = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto deviations = [&](const std::vector<float>& channel) -> Eigen::VectorXd {
      const auto values = Eigen::Map<const Eigen::VectorXf>(channel.data(), size).cast<double>();
      return values.array() - values.mean();
    };
    const Eigen::VectorXd first = deviations(samples.first[i]);
    const Eigen::VectorXd other = deviations(samples.other[i]);
    const double norms = first.norm() * other.norm();
    if (norms == 0) continue;
    sum += first.dot(other) / norms;
    ++varying;
  }
  return varying == 0 ? 0 : sum / varying;
}

double median_difference(const ColorSamples& samples, const ColorMap& map) {
  std::vector<float> squares(samples.size());
  if (squares.empty()) return 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t n = 0; n < squares.size(); ++n) {
      const float mapped = map.gain[i] * samples.other[i][n] + map.offset[i];
      const float difference = samples.first[i][n] - mapped;
      squares[n] += difference * difference;
    }
  }
  return std::sqrt(double{upper_median(std::move(squares))}) / 255;
}

Eigen::VectorXf gray_difference(const ColorSamples& samples, const ColorMap& map) {
  const auto size = static_cast<Eigen::Index>(samples.size());
  Eigen::ArrayXf sum = Eigen::ArrayXf::Zero(size);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Map<const Eigen::ArrayXf> first(samples.first[i].data(), size);
    const Eigen::Map<const Eigen::ArrayXf> other(samples.other[i].data(), size);
    sum += first - map.gain[i] * other - map.offset[i];
  }
  return sum / 3;
}

}  // namespace hypotrack::internal
