#include <opencv2/imgproc.hpp>

#include "track/color/color_samples.hpp"

namespace hypotrack::internal {

cv::Mat extrapolate(const cv::Mat& inside, const Eigen::VectorXf& values, cv::Size tile) {
  constexpr double kReach = 1.5;        // grid points
  constexpr double kLeastShare = 0.05;  // least share of neighbours with values
  cv::Mat image = cv::Mat::zeros(inside.size(), CV_32F);
  Eigen::Index next = 0;
  for (int y = 0; y < inside.rows; ++y)
    for (int x = 0; x < inside.cols; ++x)
      if (inside.at<unsigned char>(y, x) != 0) image.at<float>(y, x) = values[next++];
  cv::Mat share, around;
  inside.convertTo(share, CV_32F, 1.0 / 255);
  cv::GaussianBlur(share, share, {}, kReach);
  cv::GaussianBlur(image, around, {}, kReach);
  around /= share + kLeastShare;
  image.copyTo(around, inside);
  cv::Mat out;
  cv::resize(around, out, tile, 0, 0, cv::INTER_LINEAR);
  return out;
}

}  // namespace hypotrack::internal
