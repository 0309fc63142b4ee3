#include "figure.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace hypotrack::particles {
namespace {

constexpr int kGap = 8;
constexpr int kLine = 26;  // height of a line of text

/// Writes text into the line whose top left corner is given, no wider than `width`.
void write(cv::Mat& image, const std::string& text, cv::Point corner, int width, double scale,
           int thickness) {
  int below = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, thickness, &below);
  const double fitting =
      scale * std::min(1.0, static_cast<double>(width) / std::max(size.width, 1));
  cv::putText(image, text, corner + cv::Point(0, kLine - kGap), cv::FONT_HERSHEY_SIMPLEX, fitting,
              cv::Scalar::all(30), thickness, cv::LINE_AA);
}

cv::Mat scaled(const cv::Mat& picture) {
  if (picture.size() == cv::Size(kPanel, kPanel)) return picture;
  cv::Mat out;
  cv::resize(picture, out, cv::Size(kPanel, kPanel), 0, 0,
             picture.cols > kPanel ? cv::INTER_AREA : cv::INTER_NEAREST);
  return out;
}

}  // namespace

void Figure::add_row(std::string label, std::vector<Panel> panels) {
  rows_.push_back({std::move(label), std::move(panels)});
}

cv::Mat Figure::draw() const {
  constexpr double kHead = 0.65, kRow = 0.55, kLabel = 0.45;
  std::size_t columns = 3;
  for (const Row& row : rows_) columns = std::max(columns, row.panels.size());
  const int step = kPanel + kGap;
  const int width = kGap + static_cast<int>(columns) * step;
  const int row_height = 2 * kLine + kPanel + kGap;
  cv::Mat image(2 * kGap + kLine + static_cast<int>(rows_.size()) * row_height, width, CV_8UC3,
                cv::Scalar::all(255));
  const int whole = width - 2 * kGap;
  write(image, headline_, {kGap, kGap}, whole, kHead, 2);
  int top = kGap + kLine;
  for (const Row& row : rows_) {
    write(image, row.label, {kGap, top}, whole, kRow, 1);
    int left = kGap;
    for (const Panel& panel : row.panels) {
      write(image, panel.label, {left, top + kLine}, kPanel, kLabel, 1);
      scaled(panel.picture).copyTo(image(cv::Rect(left, top + 2 * kLine, kPanel, kPanel)));
      left += step;
    }
    top += row_height;
  }
  return image;
}

}  // namespace hypotrack::particles
