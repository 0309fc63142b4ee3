#include "calibrate/missing_board.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace hypotrack::calibrate {
namespace {

/// Returns a small grey picture: 320 pixels wide at most.
cv::Mat small_gray(const cv::Mat& picture) {
  constexpr double kWidth = 320;
  cv::Mat gray = picture, out;
  if (picture.channels() == 3) cv::cvtColor(picture, gray, cv::COLOR_BGR2GRAY);
  const double scale = std::min(1.0, kWidth / gray.cols);
  cv::resize(gray, out, {}, scale, scale, cv::INTER_AREA);
  return out;
}

/// Returns the value that a share of a picture's pixels is below.
double quantile(const cv::Mat& picture, double share) {
  cv::Mat values;
  picture.convertTo(values, CV_32F);
  std::vector<float> all(values.begin<float>(), values.end<float>());
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(share * double(all.size() - 1));
  std::ranges::nth_element(all, at);
  return *at;
}

/// Returns the slope of the steepest edges, in grey levels per pixel.
double steepest(const cv::Mat& gray) {
  constexpr double kSobel = 8;  // sum of the weights of one side, twice
  cv::Mat dx, dy, slope;
  cv::Sobel(gray, dx, CV_32F, 1, 0, 3, 1 / kSobel);
  cv::Sobel(gray, dy, CV_32F, 0, 1, 3, 1 / kSobel);
  cv::magnitude(dx, dy, slope);
  return quantile(slope, 0.995);
}

}  // namespace

std::string why_no_board(const BoardFinder& finder, const cv::Mat& picture) {
  constexpr double kDark = 60, kBright = 230, kFlat = 25;  // grey levels
  constexpr double kBlurred = 0.12;                        // slope as a share of the contrast
  const cv::Mat gray = small_gray(picture);
  const double black = quantile(gray, 0.02), white = quantile(gray, 0.98);
  if (white < kDark) return "too dark";
  if (black > kBright) return "too bright";
  if (white - black < kFlat) return "nothing is seen: is the lens covered?";
  if (steepest(gray) < kBlurred * (white - black)) return "blurred";
  if (finder.sees_part(picture)) return "only a part of the board is seen";
  return "no board is seen";
}

}  // namespace hypotrack::calibrate
