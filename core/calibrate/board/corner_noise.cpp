#include "calibrate/board/corner_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::calibrate {
namespace {

/// Interpolates a picture; nothing outside.
std::optional<double> value_at(const cv::Mat& gray, const cv::Point2d& at) {
  const int x = cvFloor(at.x), y = cvFloor(at.y);
  if (x < 0 || y < 0 || x + 1 >= gray.cols || y + 1 >= gray.rows) return std::nullopt;
  const double u = at.x - x, v = at.y - y;
  const auto* above = gray.ptr<uchar>(y) + x;
  const auto* below = gray.ptr<uchar>(y + 1) + x;
  return (1 - v) * ((1 - u) * above[0] + u * above[1]) + v * ((1 - u) * below[0] + u * below[1]);
}

/// Contrast and steepest slope across the middle of an edge.
struct Profile {
  double contrast = 0, slope = 0;
};

/// Measures across an edge, `reach` pixels to each side.
std::optional<Profile> profile_of(const cv::Mat& gray, const cv::Point2d& from,
                                  const cv::Point2d& to, double reach) {
  constexpr double kStep = 0.25;  // pixels
  const cv::Point2d along = (to - from) / cv::norm(to - from), across(-along.y, along.x);
  const cv::Point2d middle = (from + to) / 2;
  const int half = static_cast<int>(reach / kStep);
  std::vector<double> values;
  for (int i = -half; i <= half; ++i) {
    const std::optional<double> value = value_at(gray, middle + i * kStep * across);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  const auto [least, most] = std::ranges::minmax(values);
  Profile out{most - least, 0};
  constexpr std::size_t kApart = 4;  // a pixel
  for (std::size_t i = kApart; i < values.size(); ++i)
    out.slope = std::max(out.slope, std::abs(values[i] - values[i - kApart]));
  return out;
}

/// Returns the standard deviation of the noise around the corners: of what a Laplacian of second
/// differences leaves (Immerkaer 1996), of its quieter part, where no edges are.
double noise_of(const cv::Mat& gray, const BoardCorners& corners) {
  constexpr double kQuiet = 0.3, kQuantile = 0.385, kGain = 6;
  const cv::Rect board = cv::boundingRect(corners.at) & cv::Rect({0, 0}, gray.size());
  const cv::Matx33f kernel(1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat left;
  cv::filter2D(gray(board), left, CV_32F, kernel);
  std::vector<float> sizes;
  for (const float value : cv::Mat1f(left)) sizes.push_back(std::abs(value));
  const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(kQuiet * double(sizes.size() - 1));
  std::ranges::nth_element(sizes, at);
  return *at / (kQuantile * kGain);
}

}  // namespace

EdgeLook edge_look(const cv::Mat& gray, const BoardCorners& corners, int columns) {
  constexpr double kReach = 0.12;  // of a square: markers usually begin after that
  constexpr double kLeastReach = 1.5;
  std::vector<double> contrasts, blurs;
  for (std::size_t i = 1; i < corners.at.size(); ++i) {
    const bool neighbours =
        corners.ids[i] == corners.ids[i - 1] + 1 && corners.ids[i] % columns != 0;
    if (!neighbours) continue;
    const cv::Point2d from = corners.at[i - 1], to = corners.at[i];
    const double reach = std::max(kLeastReach, kReach * cv::norm(to - from));
    const std::optional<Profile> profile = profile_of(gray, from, to, reach);
    if (!profile || profile->slope <= 0) continue;
    contrasts.push_back(profile->contrast);
    blurs.push_back(profile->contrast / profile->slope / std::sqrt(2 * std::numbers::pi));
  }
  if (blurs.empty()) return {};
  return {upper_median(blurs), upper_median(contrasts), noise_of(gray, corners)};
}

double corner_sigma(const EdgeLook& edges) {
  // Printing, flatness and the aliasing of sharp edges: of good boards, measured.
  constexpr double kOfBlur = 0.04, kLeast = 0.03;  // pixels per pixel, pixels
  constexpr double kEdge = 10;  // pixels of edges on which a coordinate of a corner depends
  if (edges.contrast <= 0) return 0;
  // The bound of Cramer and Rao for the place of an edge with a Gaussian blur.
  const double noise = edges.noise / edges.contrast *
                       std::sqrt(2 * std::sqrt(std::numbers::pi) * edges.blur / kEdge);
  return std::hypot(std::max(kLeast, kOfBlur * edges.blur), noise);
}

double expected_distance(const BoardPair& pair) {
  const double left = pair.corners[0].sigma, right = pair.corners[1].sigma;
  return left > 0 && right > 0 ? std::hypot(left, right) : 0;
}

}  // namespace hypotrack::calibrate
