#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <tuple>
#include <utility>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"
#include "track/verify/pose_verifier.hpp"
#include "track/verify/ready_threads.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kWindow = 5;              // grid points along a patch
constexpr float kFaintContrast = 2.5f;  // of a channel, 0 .. 255: contrast below it says nothing
constexpr float kClearEdge = 20.0f;     // change of colour that is an edge, 0 .. 255
constexpr double kLeastPoints = 20;

double log10_of(double value) { return std::log10(std::max(value, 0.1)); }

/// Two views' colours of the same points.
struct Pairs {
  const cv::Mat3f &first, &other;
  cv::Mat1b mask;
};

/// Sums of products of two views' colours.
struct Products {
  double both = 0, first = 0, other = 0, count = 0;

  double correlation(double floor) const {
    const double noise = floor * floor * 3 * count;
    const double scale = std::sqrt((first + noise) * (other + noise));
    return scale > 0 ? both / scale : 0;
  }
};

/// Computes the correlation around the means of all points. Contrast below `faint` says nothing.
double plain_correlation(const Pairs& pairs, double faint) {
  const cv::Scalar a = cv::mean(pairs.first, pairs.mask), b = cv::mean(pairs.other, pairs.mask);
  Products sums;
  for (int y = 0; y < pairs.mask.rows; ++y)
    for (int x = 0; x < pairs.mask.cols; ++x) {
      if (!pairs.mask(y, x)) continue;
      ++sums.count;
      for (int i = 0; i < 3; ++i) {
        const double p = pairs.first(y, x)[i] - a[i], q = pairs.other(y, x)[i] - b[i];
        sums.both += p * q;
        sums.first += p * p;
        sums.other += q * q;
      }
    }
  return sums.correlation(faint);
}

/// Four numbers at every point of a grid, with a border of zeros.
class Quads {
 public:
  explicit Quads(const cv::Size& size)
      : pitch_(size.width + 2 * kBorder), numbers_(4, pitch_ * (size.height + 2 * kBorder)) {
    numbers_.setZero();
  }
  auto operator()(int x, int y) { return numbers_.col(place(x, y)); }
  /// Returns the sums over the windows around the points. Those of the border are not valid.
  Quads sums() const { return Quads(Quads(*this, 1), pitch_); }

 private:
  static constexpr int kBorder = kWindow / 2;
  using Numbers = Eigen::Array<float, 4, Eigen::Dynamic>;

  /// Makes each number the sum of five of others, `step` apart.
  Quads(const Quads& from, Eigen::Index step)
      : pitch_(from.pitch_), numbers_(4, from.numbers_.cols()) {
    static_assert(kWindow == 5);
    const Eigen::Index count = numbers_.cols() - 4 * step;
    const auto at = [&](int k) { return from.numbers_.middleCols(k * step, count); };
    numbers_.middleCols(2 * step, count) = at(0) + at(1) + at(2) + at(3) + at(4);
    numbers_.leftCols(2 * step).setZero();
    numbers_.rightCols(2 * step).setZero();
  }
  Eigen::Index place(int x, int y) const { return (y + kBorder) * pitch_ + x + kBorder; }

  Eigen::Index pitch_;
  Numbers numbers_;
};

/// Subtracts from each masked colour the mean of those in its window. The fourth number is their
/// count.
Quads without_local_mean(const cv::Mat3f& color, const cv::Mat1b& mask) {
  Quads shown(color.size());  // colour, 1
  for (int y = 0; y < color.rows; ++y)
    for (int x = 0; x < color.cols; ++x)
      if (mask(y, x)) shown(x, y) << color(y, x)[0], color(y, x)[1], color(y, x)[2], 1;
  Quads out = shown.sums();
  for (int y = 0; y < color.rows; ++y)
    for (int x = 0; x < color.cols; ++x) {
      if (!mask(y, x)) continue;
      const float count = out(x, y)[3];
      out(x, y) = shown(x, y) - out(x, y) / count;
      out(x, y)[3] = count;
    }
  return out;
}

/// Averages a measurement over pieces of the grid that overlap by half.
class Pieces {
 public:
  explicit Pieces(int grid)
      : along_(grid / kStep - 1),
        sum_(static_cast<std::size_t>(along_) * static_cast<std::size_t>(along_)),
        count_(sum_.size()) {}

  void add(int x, int y, double value) {
    for (const int row : {y / kStep - 1, y / kStep})
      for (const int column : {x / kStep - 1, x / kStep}) {
        if (row < 0 || column < 0 || row >= along_ || column >= along_) continue;
        const auto i = static_cast<std::size_t>(row * along_ + column);
        sum_[i] += value;
        count_[i] += 1;
      }
  }
  /// Returns the mean of the lowest tenth of the pieces with enough points; `otherwise` if there is
  /// none.
  double lowest(double otherwise) const { return extreme(otherwise, std::less<>()); }
  double highest(double otherwise) const { return extreme(otherwise, std::greater<>()); }

 private:
  static constexpr int kStep = 4;

  template <class Before>
  double extreme(double otherwise, Before before) const {
    constexpr double kHalfAPiece = 2 * kStep * kStep;  // half a piece
    std::vector<double> means;
    for (std::size_t i = 0; i < sum_.size(); ++i)
      if (count_[i] >= kHalfAPiece) means.push_back(sum_[i] / count_[i]);
    if (means.empty()) return otherwise;
    std::ranges::sort(means, before);
    const std::size_t few = (means.size() + 9) / 10;
    return std::accumulate(means.begin(), means.begin() + static_cast<std::ptrdiff_t>(few), 0.0) /
           static_cast<double>(few);
  }

  int along_;  ///< pieces along a side
  std::vector<double> sum_, count_;
};

/// Patch statistics: correlation over all, share of patches that agree, contrast.
struct Texture {
  double correlation = 0, agreement = 0, contrast = 0, worst_agreement = 0;
};

Texture texture(const Pairs& pairs, float faint) {
  Quads a = without_local_mean(pairs.first, pairs.mask);
  Quads b = without_local_mean(pairs.other, pairs.mask);
  Quads products(pairs.mask.size());  // a b, a a, b b at every point
  Products sums;
  for (int y = 0; y < pairs.mask.rows; ++y)
    for (int x = 0; x < pairs.mask.cols; ++x) {
      if (!pairs.mask(y, x)) continue;
      const Eigen::Array3f p = a(x, y).head<3>(), q = b(x, y).head<3>();
      const float both = (p * q).sum(), first = p.square().sum(), other = q.square().sum();
      products(x, y) << both, first, other, 0;
      ++sums.count;
      sums.both += double{both};
      sums.first += double{first};
      sums.other += double{other};
    }
  if (sums.count < kLeastPoints) return {};
  Quads local = products.sums();
  int agree = 0;
  Pieces pieces(pairs.mask.rows);
  for (int y = 0; y < pairs.mask.rows; ++y)
    for (int x = 0; x < pairs.mask.cols; ++x) {
      if (!pairs.mask(y, x)) continue;
      const auto p = local(x, y);
      const float noise = faint * faint * a(x, y)[3];
      const bool agrees = p[0] > 0.5f * std::sqrt((p[1] + noise) * (p[2] + noise));
      agree += agrees;
      pieces.add(x, y, agrees);
    }
  const double variance = std::sqrt(sums.first * sums.other) / (3 * sums.count);
  const double agreement = agree / sums.count;
  return {sums.correlation(double{faint}), agreement, log10_of(std::sqrt(variance)),
          pieces.lowest(agreement)};
}

double median_difference(const Pairs& pairs) {
  std::vector<float> distances;
  for (int y = 0; y < pairs.mask.rows; ++y)
    for (int x = 0; x < pairs.mask.cols; ++x)
      if (pairs.mask(y, x))
        distances.push_back(static_cast<float>(cv::norm(pairs.first(y, x) - pairs.other(y, x))));
  return log10_of(distances.empty() ? 0 : double{upper_median(std::move(distances))});
}

/// Computes the total variation distance of the colour histograms inside and beside a silhouette,
/// in bins of 32 levels.
double separation(const SampledView& view) {
  constexpr int kLevels = 8;
  std::vector<double> inside(kLevels * kLevels * kLevels), ring(inside.size());
  double n = 0, m = 0;
  for (int y = 0; y < view.color.rows; ++y)
    for (int x = 0; x < view.color.cols; ++x) {
      if (!view.inside(y, x) && !view.ring(y, x)) continue;
      const cv::Vec3f& c = view.color(y, x);
      int bin = 0;
      for (int i = 0; i < 3; ++i)
        bin = bin * kLevels + std::clamp(static_cast<int>(c[i] / 32), 0, kLevels - 1);
      const auto k = static_cast<std::size_t>(bin);
      view.inside(y, x) ? ++inside[k] : ++ring[k];
      view.inside(y, x) ? ++n : ++m;
    }
  if (n == 0 || m == 0) return 0;
  double distance = 0;
  for (std::size_t i = 0; i < inside.size(); ++i) distance += std::abs(inside[i] / n - ring[i] / m);
  return distance / 2;
}

/// Colour changes across a silhouette, compared with changes along the same lines on either side.
struct Edges {
  double share = 0, ratio = 0, worst_share = 0;
};

Edges edges(const SampledView& view) {
  static const std::array<cv::Point, 4> kNeighbors{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const cv::Rect grid(0, 0, view.color.cols, view.color.rows);
  const auto shown = [&](const cv::Mat1b& mask, cv::Point p) {
    return grid.contains(p) && mask(p) != 0;
  };
  double across = 0, nearby = 0, clear = 0;
  int count = 0, others = 0;
  const cv::Moments shape = cv::moments(view.inside, true);
  const double x0 = shape.m10 / std::max(shape.m00, 1.0), y0 = shape.m01 / std::max(shape.m00, 1.0);
  constexpr int kSectors = 8;
  std::array<int, kSectors> sector_count{}, sector_clear{};
  for (int y = 0; y < view.color.rows; ++y)
    for (int x = 0; x < view.color.cols; ++x) {
      const cv::Point p(x, y);
      if (!view.inside(p)) continue;
      for (const cv::Point& step : kNeighbors) {
        const cv::Point in = p - step, out = p + 2 * step;
        if (!shown(view.ring, p + step) || !shown(view.ring, out) || !shown(view.inside, in))
          continue;
        const double change = cv::norm(view.color(in) - view.color(out));
        across += change;
        const bool is_clear = change > double{kClearEdge};
        const double angle = std::atan2(y - y0, x - x0) / (2 * std::numbers::pi) + 0.5;
        const auto sector =
            static_cast<std::size_t>(std::min(kSectors - 1, static_cast<int>(angle * kSectors)));
        ++sector_count[sector];
        sector_clear[sector] += is_clear;
        clear += is_clear;
        ++count;
        for (const auto& [a, b, mask] : {std::tuple{in, in - 3 * step, &view.inside},
                                         std::tuple{out, out + 3 * step, &view.ring}}) {
          if (!shown(*mask, b)) continue;
          nearby += cv::norm(view.color(a) - view.color(b));
          ++others;
        }
      }
    }
  if (count == 0) return {};
  const double here = across / count, there = others > 0 ? nearby / others : 0;
  double worst = 1;
  for (std::size_t i = 0; i < kSectors; ++i)
    if (sector_count[i] >= 6) worst = std::min(worst, double(sector_clear[i]) / sector_count[i]);
  return {clear / count, std::log10((here + 5) / (there + 5)), worst};
}

/// Foreground probability over the points of a mask, in both views.
struct Probability {
  double mean = 0, lowest = 0, highest = 0;
};

Probability probability(const SurfaceSamples& samples, const ForegroundColors& colors,
                        cv::Mat1b SampledView::*mask) {
  double sum = 0, lowest = 1, highest = 0;
  int count = 0;
  for (const SampledView& view : samples.views) {
    Pieces pieces(view.color.rows);
    for (int y = 0; y < view.color.rows; ++y)
      for (int x = 0; x < view.color.cols; ++x) {
        if (!(view.*mask)(y, x)) continue;
        const double p = double{colors.probability(view.color(y, x))};
        sum += p;
        ++count;
        pieces.add(x, y, p);
      }
    lowest = std::min(lowest, pieces.lowest(1));
    highest = std::max(highest, pieces.highest(0));
  }
  return {count > 0 ? sum / count : 0, lowest, highest};
}

/// Returns by what to multiply the colours of dark pictures, of which judges know little; 1: of
/// none.
double brightening(const SurfaceSamples& samples) {
  constexpr double kBrightest = 0.02;  // share of the points
  constexpr double kExposed = 80;      // levels that they have in other pictures
  constexpr double kMostNoise = 5;     // a larger factor shows nothing else
  std::vector<float> levels;
  for (const SampledView& view : samples.views)
    for (int y = 0; y < view.color.rows; ++y)
      for (int x = 0; x < view.color.cols; ++x)
        if (view.inside(y, x) || view.ring(y, x)) levels.push_back(view.color(y, x).dot({1, 1, 1}));
  if (levels.empty()) return 1;
  const auto at =
      levels.begin() + static_cast<std::ptrdiff_t>(kBrightest * static_cast<double>(levels.size()));
  std::ranges::nth_element(levels, at, std::greater<>());
  return std::clamp(kExposed / (double{*at} / 3), 1.0, kMostNoise);
}

/// Returns samples with colours multiplied by a factor.
SurfaceSamples brightened(const SurfaceSamples& samples, double factor) {
  SurfaceSamples out = samples;
  const auto brighter = [&](const cv::Mat3f& color) {
    return cv::Mat3f(cv::min(color * factor, 255.0));
  };
  for (SampledView& view : out.views) view.color = brighter(view.color);
  out.other = brighter(out.other);
  return out;
}

}  // namespace

Measures measure(const SurfaceSamples& sampled, const ForegroundColors& colors,
                 const Appearance& appearance) {
  Measures out;
  out.values[Measures::kVisible] = sampled.visible;
  out.covered = sampled.covered;
  if (sampled.empty()) return out;
  const double factor = brightening(sampled);
  const SurfaceSamples bright = factor > 1 ? brightened(sampled, factor) : SurfaceSamples();
  const SurfaceSamples& samples = factor > 1 ? bright : sampled;
  const float faint = kFaintContrast * static_cast<float>(factor);
  const SampledView& first = samples.views[0];
  cv::Mat1b core;
  cv::erode(first.inside, core, cv::Mat());
  const Pairs inside{first.color, samples.other, core & samples.paired};
  const Pairs ring{first.color, samples.other, first.ring & samples.paired};
  out.points = cv::countNonZero(first.inside);
  const double core_points = cv::countNonZero(core);
  if (core_points < kLeastPoints) return out;
  out.known = true;
  Texture surface, beside;
  Edges left, right;
  Probability on, off;
  std::array<double, 2> apart{};
  run_together(
      {[&] { surface = texture(inside, faint); }, [&] { beside = texture(ring, faint); },
       [&] { out.likeness = appearance.likeness(sampled); },
       [&] { on = probability(sampled, colors, &SampledView::inside); },
       [&] { off = probability(sampled, colors, &SampledView::ring); },
       [&] { left = edges(samples.views[0]); }, [&] { right = edges(samples.views[1]); },
       [&] { apart[0] = separation(samples.views[0]); },
       [&] { apart[1] = separation(samples.views[1]); },
       [&] { out.values[Measures::kCorrelation] = plain_correlation(inside, double{faint}); },
       [&] { out.values[Measures::kDifference] = median_difference(inside); },
       [&] { out.values[Measures::kRingDifference] = median_difference(ring); }});
  out.values[Measures::kTexture] = surface.correlation;
  out.values[Measures::kAgreement] = surface.agreement;
  out.values[Measures::kContrast] = surface.contrast;
  out.values[Measures::kRingTexture] = beside.correlation;
  out.values[Measures::kSeparation] = (apart[0] + apart[1]) / 2;
  out.values[Measures::kEdges] = std::min(left.share, right.share);
  out.values[Measures::kEdgeRatio] = std::min(left.ratio, right.ratio);
  out.values[Measures::kInside] = on.mean;
  out.values[Measures::kRing] = off.mean;
  out.values[Measures::kWorstInside] = on.lowest;
  out.values[Measures::kWorstRing] = off.highest;
  out.values[Measures::kWorstAgreement] = surface.worst_agreement;
  out.values[Measures::kWorstEdges] = std::min(left.worst_share, right.worst_share);
  out.values[Measures::kPaired] = cv::countNonZero(inside.mask) / core_points;
  return out;
}

}  // namespace hypotrack::internal
