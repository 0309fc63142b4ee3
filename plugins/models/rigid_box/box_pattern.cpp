#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "box.hpp"

namespace hypotrack {
namespace {

constexpr int kTile = 512;  // pixels

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

cv::Point somewhere(cv::RNG& random) {
  return {random.uniform(0, kTile), random.uniform(0, kTile)};
}

/// Shapes of many sizes, so that there is something to see near and far, then small lines of
/// "print".
void draw_face(cv::Mat& face, cv::RNG& random) {
  face.setTo(vivid(random));
  for (int size = kTile / 3; size >= 12; size = size * 2 / 3) {
    const int count = kTile / size * 3;
    for (int i = 0; i < count; ++i) {
      const cv::Point at = somewhere(random);
      const int radius = std::max(2, size / 2 + random.uniform(-size / 4, size / 4));
      if (random.uniform(0, 2) == 0) {
        cv::circle(face, at, radius, vivid(random), cv::FILLED, cv::LINE_AA);
      } else {
        cv::ellipse(face,
                    cv::RotatedRect(
                        at, cv::Size2f(static_cast<float>(2 * radius), static_cast<float>(radius)),
                        static_cast<float>(random.uniform(0, 180))),
                    vivid(random), cv::FILLED, cv::LINE_AA);
      }
    }
  }
  for (int i = 0; i < 60; ++i) {
    const cv::Point at = somewhere(random);
    const cv::Scalar ink = random.uniform(0, 2) == 0 ? cv::Scalar(25, 25, 25) : vivid(random);
    cv::line(face, at, at + cv::Point(random.uniform(15, 60), random.uniform(-6, 6)), ink,
             random.uniform(2, 6), cv::LINE_AA);
  }
}

}  // namespace

cv::Mat box_pattern(int seed) {
  cv::Mat texture(kBoxRows * kTile, kBoxColumns * kTile, CV_8UC3);
  cv::RNG random(static_cast<std::uint64_t>(seed) * 2654435761u + 88172645463325252u);
  for (int row = 0; row < kBoxRows; ++row) {
    for (int column = 0; column < kBoxColumns; ++column) {
      cv::Mat face = texture(cv::Rect(column * kTile, row * kTile, kTile, kTile));
      draw_face(face, random);
    }
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
  cv::repeat(tile, kBoxRows, kBoxColumns, texture);
  return texture;
}

}  // namespace hypotrack
