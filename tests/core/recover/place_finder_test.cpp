#include "track/recover/place_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "camera_pair.hpp"

namespace hypotrack {
namespace {

constexpr double kFarApart = 0.12;
constexpr double kRadius = 0.045;
const cv::Scalar kSkin(110, 140, 200), kGreen(80, 160, 60);

/// Discs of skin before green, striped so that views can be compared.
Frame discs(const std::vector<Eigen::Vector3d>& centers) {
  Frame frame;
  for (const Camera& camera : test::camera_pair(kFarApart)) {
    cv::Mat picture(camera.height, camera.width, CV_8UC3, kGreen);
    for (const Eigen::Vector3d& center : centers) {
      const Eigen::Vector2d p = project(camera, center);
      const double r = camera.fx * kRadius / center.z();
      const cv::Point at(static_cast<int>(std::lround(p.x())),
                         static_cast<int>(std::lround(p.y())));
      cv::circle(picture, at, static_cast<int>(r), kSkin, cv::FILLED);
      cv::circle(picture, at, static_cast<int>(r / 2), 0.7 * kSkin, 3);
      cv::line(picture, at, at + cv::Point(static_cast<int>(r), 0), 0.7 * kSkin, 3);
    }
    frame.views.push_back({.color = picture});
  }
  return frame;
}

ForegroundColors skin() {
  SurfaceSamples samples;
  for (SampledView& view : samples.views) {
    view.color = cv::Mat3f(kSampleGrid, kSampleGrid);
    view.color.setTo(kGreen);
    view.inside = cv::Mat1b(kSampleGrid, kSampleGrid, uchar{0});
    cv::circle(view.inside, {32, 32}, 16, 255, cv::FILLED);
    view.color.setTo(kSkin, view.inside);
    cv::circle(view.color, {32, 32}, 8, 0.7 * kSkin, 3);
    cv::bitwise_not(view.inside, view.ring);
  }
  ForegroundColors colors;
  colors.learn(samples);
  return colors;
}

/// Cameras whose reduction leaves columns and rows over, and one that is hardly reduced.
TEST(PlaceFinder, ReducesPicturesToTheMeansOfSquares) {
  for (const auto& [width, by] : {std::pair{640, 3}, {250, 1}, {1281, 5}, {5040, 21}}) {
    std::vector<Camera> cameras = test::camera_pair(kFarApart);
    cameras[0].width = width;
    const PlaceFinder finder(cameras, kRadius, 0.25, 1.2);
    ASSERT_EQ(finder.reduction(0), by);
    // What is left over is spread where OpenCV reduces.
    cv::Mat3b picture(by > 16 ? 3 * by : 3 * by + by / 2, width);
    cv::randu(picture, 0, 256);
    const cv::Mat3b reduced = finder.reduced(picture, 0);
    ASSERT_EQ(reduced.size(), cv::Size(width / by, 3));
    for (int y = 0; y < reduced.rows; ++y)
      for (int x = 0; x < reduced.cols; ++x) {
        const cv::Scalar mean = cv::mean(picture(cv::Rect(by * x, by * y, by, by)));
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(reduced(y, x)[i], mean[i], 0.501);
      }
  }
}

TEST(PlaceFinder, FindsWhatHasTheColorsAtItsDepth) {
  const PlaceFinder finder(test::camera_pair(kFarApart), kRadius, 0.25, 1.2);
  for (const Eigen::Vector3d& center :
       {Eigen::Vector3d(0.05, -0.04, 0.5), Eigen::Vector3d(-0.02, 0.06, 0.7)}) {
    const Places places = finder.find(discs({center}), skin(), {}, 3);
    ASSERT_FALSE(places.best.empty());
    EXPECT_LT((places.best[0].center - center).norm(), 0.03);
    EXPECT_GT(places.seen, 0.7);
  }
}

TEST(PlaceFinder, FindsSeveralPlacesApart) {
  const std::vector<Eigen::Vector3d> centers{{0.14, -0.04, 0.6}, {-0.08, 0.06, 0.6}};
  const Places places = PlaceFinder(test::camera_pair(kFarApart), kRadius, 0.25, 1.2)
                            .find(discs(centers), skin(), {}, 4);
  for (const Eigen::Vector3d& center : centers)
    EXPECT_TRUE(std::ranges::any_of(
        places.best, [&](const Place& place) { return (place.center - center).norm() < 0.04; }));
  for (std::size_t i = 0; i < places.best.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_GE((places.best[i].center - places.best[k].center).norm(), 0.07);
}

TEST(PlaceFinder, CoversLongThingsPlaceByPlace) {
  std::vector<Eigen::Vector3d> arm;
  for (int i = 0; i < 6; ++i) arm.emplace_back(-0.15 + 0.06 * i, 0.01 * i, 0.6);
  const Places places =
      PlaceFinder(test::camera_pair(kFarApart), kRadius, 0.25, 1.2).find(discs(arm), skin(), {}, 6);
  for (const Eigen::Vector3d& end : {arm.front(), arm.back()})
    EXPECT_TRUE(std::ranges::any_of(
        places.best, [&](const Place& place) { return (place.center - end).norm() < 0.06; }));
}

TEST(PlaceFinder, LeavesOutPixelsOfWeightZero) {
  const PlaceFinder finder(test::camera_pair(kFarApart), kRadius, 0.25, 1.2);
  const Eigen::Vector3d here(-0.1, 0.02, 0.55), there(0.12, 0, 0.5);
  const auto cameras = test::camera_pair(kFarApart);
  std::array<cv::Mat1f, 2> weights;
  for (std::size_t i = 0; i < 2; ++i) {
    const int by = finder.reduction(i);
    weights[i] = cv::Mat1f(480 / by, 640 / by, 1.0f);
    const Eigen::Vector2d p = project(cameras[i], here) / by;
    cv::circle(weights[i], {static_cast<int>(p.x()), static_cast<int>(p.y())}, 60 / by, 0,
               cv::FILLED);
  }
  const Places places = finder.find(discs({here, there}), skin(), {}, 1, weights);
  ASSERT_EQ(places.best.size(), 1U);
  EXPECT_LT((places.best[0].center - there).norm(), 0.03);
}

TEST(PlaceFinder, SeesNothingInPicturesWithoutTheColors) {
  const Places places =
      PlaceFinder(test::camera_pair(kFarApart), kRadius, 0.25, 1.2).find(discs({}), skin(), {}, 4);
  EXPECT_TRUE(places.best.empty());
  EXPECT_LT(places.seen, 0.1);
}

TEST(PlaceFinder, FindsNothingBeforeColorsAreKnown) {
  const Places places = PlaceFinder(test::camera_pair(kFarApart), kRadius, 0.25, 1.2)
                            .find(discs({{0, 0, 0.5}}), {}, {}, 4);
  EXPECT_TRUE(places.best.empty());
}

}  // namespace
}  // namespace hypotrack
