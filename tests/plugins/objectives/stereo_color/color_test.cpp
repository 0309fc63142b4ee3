#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "color-inl.hpp"
#include "hypotrack/plugin/pixel.hpp"

// The colour arithmetic that CUDA shares, against OpenCV's, which the CPU uses.
namespace hypotrack::stereo_color {
namespace {

// Colours all over the cube, its corners among them.
cv::Mat3b many_colors() {
  cv::Mat3b out(0, 1);
  for (int r = 0; r < 256; r += 3) {
    for (int g = 0; g < 256; g += 3) {
      for (int b = 0; b < 256; b += 3) {
        out.push_back(cv::Vec3b(static_cast<uchar>(b), static_cast<uchar>(g), uchar(r)));
      }
    }
  }
  return out;
}

cv::Mat3f opencv(const cv::Mat3b& bgr, int code) {
  cv::Mat3f scaled, out;
  bgr.convertTo(scaled, CV_32F, 1.0 / 255.0);
  cv::cvtColor(scaled, out, code);
  return out;
}

// In units of the 16-bit packing.
int difference(const Channels& a, const Channels& b) {
  const auto apart = [](float x, float y) {
    return std::abs(static_cast<int>(pack_unorm16(x, 0)) - static_cast<int>(pack_unorm16(y, 0)));
  };
  return std::max({apart(a.c0, b.c0), apart(a.c1, b.c1), apart(a.c2, b.c2)});
}

Bgr to_bgr(const cv::Vec3b& p) { return {p[0], p[1], p[2]}; }

TEST(Color, EightBitRgbIsPackedExactly) {
  for (unsigned k = 0; k < 256; ++k) {
    const auto byte = static_cast<std::uint8_t>(k);
    const Channels c = rgb_channels({0, byte, 255});
    EXPECT_EQ(pack_unorm16(c.c1, c.c0), 257 * k | 65535u << 16);
  }
}

TEST(Color, HsvIsOpenCVs) {
  const cv::Mat3b colors = many_colors();
  const cv::Mat3f expected = opencv(colors, cv::COLOR_BGR2HSV);
  int worst = 0;
  for (int i = 0; i < colors.rows; ++i) {
    const cv::Vec3f& e = expected(i);
    const Channels found = on_cone(to_hsv(rgb_channels(to_bgr(colors(i)))));
    worst = std::max(worst, difference(found, on_cone({e[0], e[1], e[2]})));
  }
  EXPECT_LE(worst, 1);
}

TEST(Color, LabIsOpenCVs) {
  const std::vector<LabNode> nodes = lab_nodes();
  const cv::Mat3b colors = many_colors();
  const cv::Mat3f expected = opencv(colors, cv::COLOR_BGR2Lab);
  int worst = 0;
  for (int i = 0; i < colors.rows; ++i) {
    const cv::Vec3f& e = expected(i);
    const Channels found = to_lab(to_bgr(colors(i)), nodes.data());
    worst = std::max(worst, difference(found, lab_channels(e[0], e[1], e[2])));
  }
  EXPECT_LE(worst, 1);
}

}  // namespace
}  // namespace hypotrack::stereo_color
