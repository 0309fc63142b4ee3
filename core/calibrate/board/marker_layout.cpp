#include "calibrate/board/marker_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "hypotrack/plugin/numbers.hpp"

namespace hypotrack::calibrate {
namespace {

cv::Point2f centre_of(const std::vector<cv::Point2f>& corners) {
  return (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
}

/// Returns where the other markers are, in sides of a marker and from its centre.
std::vector<cv::Point2f> seen_from(const std::vector<cv::Point2f>& marker,
                                   const std::vector<cv::Point2f>& centres) {
  const std::array<cv::Point2f, 4> unit = {
      {{-0.5F, -0.5F}, {0.5F, -0.5F}, {0.5F, 0.5F}, {-0.5F, 0.5F}}};
  std::vector<cv::Point2f> out;
  cv::perspectiveTransform(centres, out, cv::getPerspectiveTransform(marker.data(), unit.data()));
  return out;
}

float reach_of(const cv::Point2f& step) { return std::max(std::abs(step.x), std::abs(step.y)); }

}  // namespace

cv::Point MarkerLayout::square_of(int id) const {
  const int two_rows = id / columns, rest = id % columns;
  const int first_row = marker_first ? (columns + 1) / 2 : columns / 2;
  const int start = marker_first ? 0 : 1;
  if (rest < first_row) return {2 * rest + start, 2 * two_rows};
  return {2 * (rest - first_row) + 1 - start, 2 * two_rows + 1};
}

int MarkerLayout::markers_in(int rows) const {
  const int squares = columns * rows;
  return marker_first ? (squares + 1) / 2 : squares / 2;
}

MarkerSteps marker_steps(const Markers& markers) {
  constexpr float kFarthest = 4;  // sides of a marker: more is seen with too little accuracy
  const std::size_t count = markers.ids.size();
  std::vector<cv::Point2f> centres;
  for (const auto& corners : markers.corners) centres.push_back(centre_of(corners));
  std::vector<std::vector<cv::Point2f>> views;
  std::vector<double> nearest;  // a neighbour across a corner of the square is one square away
  for (std::size_t i = 0; i < count && count > 1; ++i) {
    views.push_back(seen_from(markers.corners[i], centres));
    float least = kFarthest;
    for (std::size_t j = 0; j < count; ++j)
      if (j != i) least = std::min(least, reach_of(views[i][j]));
    if (least < kFarthest) nearest.push_back(least);
  }
  MarkerSteps out;
  if (nearest.empty()) return out;
  out.square = upper_median(nearest);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      const cv::Point2f step = views[i][j] / out.square;
      const cv::Point rounded(cvRound(step.x), cvRound(step.y));
      if (i != j && std::max(std::abs(rounded.x), std::abs(rounded.y)) == 1)
        out.all.push_back({markers.ids[i], markers.ids[j], rounded});
    }
  return out;
}

double agreement(const MarkerLayout& layout, std::span<const MarkerStep> steps) {
  const auto explained = std::ranges::count_if(steps, [&](const MarkerStep& step) {
    return layout.square_of(step.to) - layout.square_of(step.from) == step.squares;
  });
  return steps.empty() ? 0 : static_cast<double>(explained) / static_cast<double>(steps.size());
}

std::optional<MarkerLayout> fitting_layout(std::span<const MarkerStep> steps) {
  constexpr std::size_t kLeastSteps = 6;
  constexpr int kMostColumns = 100;
  std::optional<MarkerLayout> out;
  double best = kFits;
  for (int columns = 3; columns <= kMostColumns && steps.size() >= kLeastSteps; ++columns)
    for (const bool marker_first : {false, true}) {
      const MarkerLayout layout{columns, marker_first};
      if (const double share = agreement(layout, steps); share > best) {
        best = share;
        out = layout;
      }
    }
  return out;
}

}  // namespace hypotrack::calibrate
