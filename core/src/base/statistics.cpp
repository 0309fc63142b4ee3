#include "base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>

namespace hypotrack::internal {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<double> without_nan(std::span<const double> values) {
  std::vector<double> known;
  std::copy_if(values.begin(), values.end(), std::back_inserter(known),
               [](double value) { return !std::isnan(value); });
  return known;
}

double mean(std::span<const double> values) {
  if (values.empty()) return kNan;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standard_deviation(std::span<const double> values) {
  const double center = mean(values);
  std::vector<double> squares;
  for (const double value : values) squares.push_back((value - center) * (value - center));
  return std::sqrt(mean(squares));
}

double sample_deviation(std::span<const double> values) {
  if (values.size() < 2) return kNan;
  const double center = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - center) * (value - center);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double percentile(std::span<const double> values, double p) {
  if (values.empty()) return kNan;
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const double position = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

double share_below(std::span<const double> values, double threshold) {
  if (values.empty()) return kNan;
  const auto below =
      std::count_if(values.begin(), values.end(), [=](double value) { return value < threshold; });
  return static_cast<double>(below) / static_cast<double>(values.size());
}

double area_under_success(std::span<const double> values, double low, double high) {
  std::vector<double> areas;
  for (const double value : values)
    areas.push_back(std::clamp((high - value) / (high - low), 0.0, 1.0));
  return mean(areas);
}

std::array<double, kSuccessCurvePoints> success_curve(std::span<const double> values) {
  std::array<double, kSuccessCurvePoints> curve{};
  for (std::size_t i = 0; i < curve.size(); ++i)
    curve[i] = share_below(values, static_cast<double>(i));
  return curve;
}

}  // namespace hypotrack::internal
