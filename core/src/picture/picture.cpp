#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "hypotrack/api/overlay.hpp"

namespace hypotrack {
namespace {

constexpr float kDarkest = 40;  // of 255; 0 is for what was not measured

std::vector<float> inverse_depths(const cv::Mat& depth) {
  std::vector<float> values;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const float z = depth.at<float>(y, x);
      if (z > 0) values.push_back(1 / z);
    }
  }
  return values;
}

/// Returns the q-quantile of the values and reorders them.
float quantile(std::vector<float>& values, double q) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Grey is linear in 1/z, so that near surfaces get most of the range. One per cent at either end
/// is clipped, so that outliers do not take the contrast.
cv::Mat depth_picture(const cv::Mat& depth) {
  cv::Mat grey = cv::Mat::zeros(depth.size(), CV_8UC1);
  std::vector<float> values = inverse_depths(depth);
  if (!values.empty()) {
    const float far = quantile(values, 0.01);
    const float near = quantile(values, 0.99);
    const float scale = near > far ? (255 - kDarkest) / (near - far) : 0;
    for (int y = 0; y < depth.rows; ++y) {
      for (int x = 0; x < depth.cols; ++x) {
        const float z = depth.at<float>(y, x);
        if (!(z > 0)) continue;
        const float level = std::clamp(255 - scale * (near - 1 / z), kDarkest, 255.0F);
        grey.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(level);
      }
    }
  }
  cv::Mat picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  return picture;
}

}  // namespace

cv::Mat picture_of(const View& view) {
  if (!view.color.empty() || view.depth.empty()) return view.color;
  return depth_picture(view.depth);
}

}  // namespace hypotrack
