#include "calibrate/board/marker_corners.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::calibrate {
namespace {

using Quad = std::vector<cv::Point2f>;

/// Returns the shortest side of a marker in pixels.
double shortest_side(const Quad& marker) {
  double out = cv::norm(marker[0] - marker[3]);
  for (std::size_t i = 1; i < 4; ++i) out = std::min(out, cv::norm(marker[i] - marker[i - 1]));
  return out;
}

/// Returns a grey picture in which markers are as white as what surrounds them.
cv::Mat without_markers(const cv::Mat& gray, const Markers& markers, double square) {
  constexpr double kGrow = 0.45;  // of the way from a marker's edge to that of its square
  constexpr int kSamples = 8;     // of each side
  constexpr int kBits = 4;        // of fractions of pixels
  const auto grow = static_cast<float>(1 + kGrow * (square - 1));
  cv::Mat out = gray.clone();
  for (const Quad& marker : markers.corners) {
    const cv::Point2f centre = (marker[0] + marker[1] + marker[2] + marker[3]) / 4;
    std::array<cv::Point2f, 4> around;
    for (std::size_t i = 0; i < 4; ++i) around[i] = centre + grow * (marker[i] - centre);
    std::vector<int> levels;
    std::vector<cv::Point> outline;
    for (std::size_t i = 0; i < 4; ++i) {
      outline.emplace_back(around[i] * (1 << kBits));
      for (int k = 0; k < kSamples; ++k) {
        const float share = static_cast<float>(k) / kSamples;
        const cv::Point at((1 - share) * around[i] + share * around[(i + 1) % 4]);
        if (cv::Rect({0, 0}, gray.size()).contains(at)) levels.push_back(gray.at<uchar>(at));
      }
    }
    if (!levels.empty())
      cv::fillConvexPoly(out, outline, cv::Scalar(upper_median(levels)), cv::LINE_AA, kBits);
  }
  return out;
}

/// A corner as the markers around it expect it.
struct Expected {
  cv::Point2f first, last;  ///< of the two markers
  int markers = 0;
  double square = 0;  ///< side in pixels
};

/// Moves a corner to where edges meet. Returns whether that is near to where it was expected.
bool refine(const cv::Mat& squares, double square, cv::Point2f& corner) {
  constexpr double kWindow = 0.45, kFar = 0.15;  // of a square
  constexpr double kLeast = 2, kMost = 24;       // pixels
  constexpr int kIterations = 40;
  constexpr double kAccuracy = 0.001;  // pixels
  const int window = static_cast<int>(std::clamp(kWindow * square, kLeast, kMost));
  const cv::Rect inside({window, window}, squares.size() - cv::Size(2 * window, 2 * window));
  if (!inside.contains(corner)) return false;
  std::vector<cv::Point2f> at = {corner};
  cv::cornerSubPix(squares, at, {window, window}, {-1, -1},
                   {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, kIterations, kAccuracy});
  const double moved = cv::norm(at[0] - corner);
  corner = at[0];
  return moved < 1 + kFar * square;
}

}  // namespace

CornerFinder::CornerFinder(const cv::Mat& gray, const Markers& markers, double square)
    : markers_(&markers), square_(square), squares_(without_markers(gray, markers, square)) {}

PatternCorners CornerFinder::corners(const MarkerLayout& layout, int rows) const {
  constexpr double kAgree = 0.25;  // of a square
  const std::array<cv::Point2f, 4> unit = {
      {{-0.5F, -0.5F}, {0.5F, -0.5F}, {0.5F, 0.5F}, {-0.5F, 0.5F}}};
  const auto half = static_cast<float>(square_ / 2);
  const std::vector<cv::Point2f> of_square = {
      {-half, -half}, {half, -half}, {half, half}, {-half, half}};
  std::map<int, Expected> expected;
  for (std::size_t i = 0; i < markers_->ids.size(); ++i) {
    const cv::Point square = layout.square_of(markers_->ids[i]);
    Quad at;
    cv::perspectiveTransform(of_square, at,
                             cv::getPerspectiveTransform(unit.data(), markers_->corners[i].data()));
    for (int k = 0; k < 4; ++k) {
      const cv::Point corner = square + cv::Point(k == 1 || k == 2 ? 1 : 0, k / 2);
      if (corner.x < 1 || corner.y < 1 || corner.x >= layout.columns || corner.y >= rows) continue;
      Expected& one = expected[(corner.y - 1) * (layout.columns - 1) + corner.x - 1];
      (one.markers++ == 0 ? one.first : one.last) = at[static_cast<std::size_t>(k)];
      const double side = square_ * shortest_side(markers_->corners[i]);
      one.square = one.square > 0 ? std::min(one.square, side) : side;
    }
  }
  PatternCorners out;
  out.marker_first = layout.marker_first;
  for (const auto& [id, one] : expected) {
    cv::Point2f corner = (one.first + one.last) / 2;
    if (one.markers != 2 || cv::norm(one.first - one.last) > 1 + kAgree * one.square ||
        !refine(squares_, one.square, corner))
      continue;
    out.ids.push_back(id);
    out.at.push_back(corner);
  }
  return out;
}

}  // namespace hypotrack::calibrate
