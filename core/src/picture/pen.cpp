#include "picture/pen.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace hypotrack::internal {
namespace {

constexpr int kPenBits = 4;  // of subpixels

cv::Scalar edge_color() { return {20, 20, 20}; }

cv::Point subpixel(const Eigen::Vector2d& p) {
  return {cvRound(p.x() * (1 << kPenBits)), cvRound(p.y() * (1 << kPenBits))};
}

}  // namespace

Pen::Pen(cv::Mat& image)
    : image_(image), width_(std::max(1, cvRound(std::max(image.cols, image.rows) / 800.0))) {}

bool Pen::is_near(const Eigen::Vector2d& p) const {
  const double margin = std::max(image_.cols, image_.rows);
  return p.x() > -margin && p.y() > -margin && p.x() < image_.cols + margin &&
         p.y() < image_.rows + margin;  // false for NaN
}

void Pen::line(const Eigen::Matrix2Xd& points, const cv::Scalar& color) {
  for (const bool edge : {true, false})
    for (Eigen::Index i = 1; i < points.cols(); ++i)
      if (is_near(points.col(i - 1)) && is_near(points.col(i)))
        cv::line(image_, subpixel(points.col(i - 1)), subpixel(points.col(i)),
                 edge ? edge_color() : color, width_ + (edge ? 2 : 0), cv::LINE_AA, kPenBits);
}

void Pen::dot(const Eigen::Vector2d& at, const cv::Scalar& color, const std::string& name) {
  if (!is_near(at)) return;
  for (const bool edge : {true, false})
    cv::circle(image_, subpixel(at), (3 * width_ + (edge ? 1 : 0)) << kPenBits,
               edge ? edge_color() : color, cv::FILLED, cv::LINE_AA, kPenBits);
  label(at, color, name);
}

void Pen::cross(const Eigen::Vector2d& at, const cv::Scalar& color, const std::string& name) {
  const double inner = 2.0 * width_, outer = 7.0 * width_;
  for (const Eigen::Vector2d& way : {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 0),
                                     Eigen::Vector2d(0, 1), Eigen::Vector2d(0, -1)}) {
    Eigen::Matrix2Xd arm(2, 2);
    arm << at + inner * way, at + outer * way;
    line(arm, color);
  }
  label(at, color, name);
}

void Pen::label(const Eigen::Vector2d& at, const cv::Scalar& color, const std::string& name) {
  if (!is_near(at)) return;
  const cv::Point beside(cvRound(at.x()) + 5 * width_, cvRound(at.y()) - 4 * width_);
  for (const bool edge : {true, false})
    cv::putText(image_, name, beside, cv::FONT_HERSHEY_SIMPLEX, 0.35 + 0.1 * width_,
                edge ? edge_color() : color, edge ? 3 : 1, cv::LINE_AA);
}

cv::Mat side_by_side(const std::vector<cv::Mat>& images, std::span<const std::string> text) {
  int width = 0, height = 0;
  for (const cv::Mat& image : images) {
    width += image.cols;
    height = std::max(height, image.rows);
  }
  const double font = std::clamp(width / 2600.0, 0.4, 1.0);
  const int line = cvRound(38 * font);
  cv::Mat out(height + line / 2 + line * static_cast<int>(text.size()), width, CV_8UC3,
              cv::Scalar(32, 32, 32));
  int x = 0;
  for (const cv::Mat& image : images) {
    image.copyTo(out(cv::Rect(x, 0, image.cols, image.rows)));
    x += image.cols;
  }
  int y = height;
  for (const std::string& words : text) {
    y += line;
    int base = 0;
    const int length = cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, font, 1, &base).width;
    const double fits = std::min(1.0, (width - 20.0) / std::max(1, length));
    cv::putText(out, words, {10, y}, cv::FONT_HERSHEY_SIMPLEX, font * fits, {235, 235, 235}, 1,
                cv::LINE_AA);
  }
  return out;
}

}  // namespace hypotrack::internal
