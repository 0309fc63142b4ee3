#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "box.hpp"

namespace hypotrack {
namespace {

cv::Scalar vivid(cv::RNG& random) {
  const cv::Mat hsv(
      1, 1, CV_8UC3,
      cv::Scalar(random.uniform(0, 180), random.uniform(90, 230), random.uniform(110, 250)));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  const auto color = bgr.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(color[0]), static_cast<double>(color[1]),
          static_cast<double>(color[2])};
}

cv::Point somewhere(const cv::Mat& face, cv::RNG& random) {
  return {random.uniform(0, face.cols), random.uniform(0, face.rows)};
}

void draw_blob(cv::Mat& face, int size, cv::RNG& random) {
  const cv::Point at = somewhere(face, random);
  const int radius = std::max(2, size / 2 + random.uniform(-size / 4, size / 4 + 1));
  if (random.uniform(0, 2) == 0) {
    cv::circle(face, at, radius, vivid(random), cv::FILLED, cv::LINE_AA);
    return;
  }
  const cv::Size2f axes(static_cast<float>(2 * radius), static_cast<float>(radius));
  const auto angle = static_cast<float>(random.uniform(0, 180));
  cv::ellipse(face, cv::RotatedRect(at, axes, angle), vivid(random), cv::FILLED, cv::LINE_AA);
}

void draw_stroke(cv::Mat& face, double unit, cv::RNG& random) {
  const cv::Point at = somewhere(face, random);
  const cv::Scalar ink = random.uniform(0, 2) == 0 ? cv::Scalar(25, 25, 25) : vivid(random);
  const cv::Point2d to(random.uniform(15.0, 60.0) * unit, random.uniform(-6.0, 6.0) * unit);
  const int thickness = std::max(1, static_cast<int>(random.uniform(2.0, 6.0) * unit));
  cv::line(face, at, at + cv::Point(to), ink, thickness, cv::LINE_AA);
}

/// Draws shapes of many sizes, visible near and far, then small lines of "print". Sizes and density
/// are those of the whole box, whose mean edge has `edge` pixels.
void draw_face(cv::Mat& face, double edge, cv::RNG& random) {
  face.setTo(vivid(random));
  const double share = static_cast<double>(face.total()) / (edge * edge);
  const double smallest = std::max(3.0, edge * 0.023);
  for (double size = edge / 3; size >= smallest; size *= 2.0 / 3) {
    const int count = std::max(1, static_cast<int>(3 * edge / size * share));
    for (int i = 0; i < count; ++i) draw_blob(face, static_cast<int>(size), random);
  }
  const int strokes = static_cast<int>(60 * share);
  for (int i = 0; i < strokes; ++i) draw_stroke(face, edge / 512, random);
}

/// Returns a face with the margin around it.
cv::Rect tile_of(const cv::Rect2d& face, const cv::Size& image) {
  const cv::Point low(static_cast<int>(face.x - kFaceMargin),
                      static_cast<int>(face.y - kFaceMargin));
  const cv::Point high(static_cast<int>(std::ceil(face.x + face.width + kFaceMargin)),
                       static_cast<int>(std::ceil(face.y + face.height + kFaceMargin)));
  return cv::Rect(low, high) & cv::Rect(cv::Point(), image);
}

}  // namespace

cv::Mat box_pattern(const BoxLayout& layout, int seed) {
  cv::Mat texture(layout.image, CV_8UC3, cv::Scalar::all(0));
  cv::RNG random(static_cast<std::uint64_t>(seed) * 2654435761u + 88172645463325252u);
  // The x faces are y wide and z high, the y faces z wide.
  const double mean_edge =
      std::cbrt(layout.faces[0].width * layout.faces[0].height * layout.faces[2].height);
  for (const cv::Rect2d& face : layout.faces) {
    cv::Mat tile = texture(tile_of(face, layout.image));
    draw_face(tile, mean_edge, random);
  }
  return texture;
}

cv::Mat repeat_on_faces(const cv::Mat& picture) {
  cv::Mat tile = picture;
  constexpr int kLargest = 2048;
  if (const int longest = std::max(picture.cols, picture.rows); longest > kLargest) {
    const double factor = static_cast<double>(kLargest) / longest;
    cv::resize(picture, tile, cv::Size(), factor, factor, cv::INTER_AREA);
  }
  cv::Mat texture;
  cv::repeat(tile, 2, 3, texture);
  return texture;
}

}  // namespace hypotrack
