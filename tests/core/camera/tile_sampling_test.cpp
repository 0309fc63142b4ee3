// What a tile's pixels are of the image's, at every scale.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "box_views.hpp"

namespace hypotrack {
namespace {

TEST(Tiles, AreTheImageItselfWhereNothingChanges) {
  const test::PlainSetup setup(1, 128);
  cv::Mat image(720, 1280, CV_8UC3);
  cv::theRNG().state = 5;
  cv::randu(image, 0, 256);
  const Observation seen = setup.make(image);
  EXPECT_EQ(seen.frame, 7);
  EXPECT_EQ(seen.time, 0.25);
  EXPECT_EQ(seen.scene, &setup.scene);
  EXPECT_FALSE(seen.rectified);
  const cv::Mat expected = image(cv::Rect(640 - 64, 360 - 64, 128, 128));
  EXPECT_LE(cv::norm(seen.views[0].color, expected, cv::NORM_INF), 5);
  EXPECT_EQ(cv::countNonZero(seen.views[0].valid), 128 * 128);
}

TEST(Tiles, AreBlockMeansAtWholeReductions) {
  for (const int factor : {2, 3, 5}) {
    const test::PlainSetup setup(factor, 64);
    cv::Mat image(720, 1280, CV_8UC3);
    cv::theRNG().state = 6;
    cv::randu(image, 0, 256);
    const cv::Mat part =
        image(cv::Rect(640 - 32 * factor, 360 - 32 * factor, 64 * factor, 64 * factor));
    cv::Mat expected;
    cv::resize(part, expected, {64, 64}, 0, 0, cv::INTER_AREA);
    cv::Mat found = setup.make(image).views[0].color;
    // Blocks are counted from the image's corner: half a block's shift is blurred by the lookup.
    cv::Mat difference;
    cv::GaussianBlur(expected, expected, {}, 1.5);
    cv::GaussianBlur(found, found, {}, 1.5);
    EXPECT_LT(cv::norm(found, expected, cv::NORM_INF), 14) << factor;
  }
}

TEST(Tiles, DoNotAliasWhenTheyReduce) {
  // Stripes finer than a tile's pixels can show must come out grey.
  for (const double scale : {2.0, 2.4, 2.9, 3.5, 4.2, 6.7}) {
    const test::PlainSetup setup(scale, 100);
    cv::Mat image(720, 1280, CV_8UC3);
    const double period = 1.15 * scale;
    for (int x = 0; x < image.cols; ++x) {
      const auto v = cv::saturate_cast<uchar>(127.5 + 127.5 * std::cos(2 * M_PI * x / period));
      image.col(x) = cv::Scalar(v, v, v);
    }
    cv::Mat grey;
    cv::extractChannel(setup.make(image).views[0].color, grey, 0);
    cv::Scalar mean, deviation;
    cv::meanStdDev(grey, mean, deviation);
    EXPECT_NEAR(mean[0], 127.5, 2) << scale;
    // The stripes' own deviation is 90.
    EXPECT_LT(deviation[0], 30) << scale;
  }
}

TEST(Tiles, ShowSmoothImagesUnchangedAtAnyScale) {
  for (const double scale : {0.3, 0.8, 1.1, 1.4, 1.9, 2.5, 3.7, 6.2}) {
    const test::PlainSetup setup(scale, 90);
    cv::Mat image(720, 1280, CV_8UC3);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        image.at<cv::Vec3b>(y, x) = {static_cast<uchar>(x / 6), static_cast<uchar>(y / 3), 77};
      }
    }
    const TileView view = setup.make(image).views[0];
    for (int v = 0; v < 90; v += 11) {
      for (int u = 0; u < 90; u += 11) {
        const double x = (u - view.camera.cx) / view.camera.fx * 700 + setup.camera.cx;
        const double y = (v - view.camera.cy) / view.camera.fy * 700 + setup.camera.cy;
        const cv::Vec3b found = view.color.at<cv::Vec3b>(v, u);
        EXPECT_NEAR(found[0], x / 6 - 0.5, 1.2) << scale;
        EXPECT_NEAR(found[1], y / 3 - 0.5, 1.2) << scale;
        EXPECT_EQ(found[2], 77);
      }
    }
  }
}
}  // namespace
}  // namespace hypotrack
