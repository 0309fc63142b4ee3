#include "calibrate/check/coverage.hpp"

#include <opencv2/imgproc.hpp>

namespace hypotrack::calibrate {
namespace {

constexpr int kCells = 6;  // along each side

/// Returns which of three parts of a side a cell is in.
int third_of(int cell) { return 3 * cell / kCells; }

}  // namespace

Coverage coverage_of(std::span<const BoardCorners* const> boards, cv::Size picture) {
  static constexpr std::array<std::array<const char*, 3>, 3> kNames = {
      {{"top left", "top", "top right"},
       {"left", "middle", "right"},
       {"bottom left", "bottom", "bottom right"}}};
  std::array<std::array<bool, kCells>, kCells> seen{};
  for (const BoardCorners* board : boards) {
    for (const cv::Point2f& at : board->at) {
      const auto cell = [](float x, int size) {
        return std::clamp(static_cast<int>(kCells * x / static_cast<float>(size)), 0, kCells - 1);
      };
      seen[static_cast<std::size_t>(cell(at.y, picture.height))]
          [static_cast<std::size_t>(cell(at.x, picture.width))] = true;
    }
  }
  Coverage out;
  std::array<std::array<int, 3>, 3> count{};
  for (int row = 0; row < kCells; ++row)
    for (int column = 0; column < kCells; ++column) {
      if (!seen[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]) continue;
      out.share += 1.0 / (kCells * kCells);
      ++count[static_cast<std::size_t>(third_of(row))][static_cast<std::size_t>(third_of(column))];
    }
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      if (count[row][column] == 0) out.empty.emplace_back(kNames[row][column]);
  return out;
}

Coverage coverage_of(const std::vector<BoardPair>& pairs, const StereoCalibration& calibration,
                     std::size_t view) {
  const Camera& camera = calibration.cameras[view];
  std::vector<const BoardCorners*> boards;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (calibration.pairs[i].counts()) boards.push_back(&pairs[i].corners[view]);
  return coverage_of(boards, {camera.width, camera.height});
}

cv::Mat draw_coverage(const std::vector<BoardPair>& pairs, const StereoCalibration& calibration) {
  const Camera &left = calibration.cameras[0], &right = calibration.cameras[1];
  cv::Mat out(std::max(left.height, right.height), left.width + right.width, CV_8UC3,
              cv::Scalar(255, 255, 255));
  for (std::size_t view = 0; view < 2; ++view) {
    const int shift = view == 0 ? 0 : left.width;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const cv::Scalar color =
          calibration.pairs[i].counts() ? cv::Scalar(60, 150, 40) : cv::Scalar(40, 40, 220);
      for (const cv::Point2f& at : pairs[i].corners[view].at)
        cv::circle(out, {cvRound(at.x) + shift, cvRound(at.y)}, std::max(2, left.width / 300),
                   color, cv::FILLED, cv::LINE_AA);
    }
  }
  cv::line(out, {left.width, 0}, {left.width, out.rows}, {0, 0, 0}, 2);
  return out;
}

}  // namespace hypotrack::calibrate
