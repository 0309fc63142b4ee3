// Tiles of pairs of cameras, of every lens and relation: where they lie and what they show.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "box_views.hpp"
#include "test_cameras.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {
namespace {

using test::at;
using test::black;
using test::box_scene;
using test::project;

/// A blurred dot whose centre of mass is exactly at `centre`.
void draw_dot(cv::Mat& image, const Eigen::Vector2d& centre, double sigma) {
  const int reach = static_cast<int>(5 * sigma) + 1;
  for (int y = int(centre.y()) - reach; y <= int(centre.y()) + reach; ++y) {
    for (int x = int(centre.x()) - reach; x <= int(centre.x()) + reach; ++x) {
      if (x < 0 || y < 0 || x >= image.cols || y >= image.rows) continue;
      const double d2 = std::pow(x - centre.x(), 2) + std::pow(y - centre.y(), 2);
      const auto value = cv::saturate_cast<uchar>(255 * std::exp(-0.5 * d2 / (sigma * sigma)));
      image.at<cv::Vec3b>(y, x) = {value, value, value};
    }
  }
}

Eigen::Vector2d centre_of_mass(const cv::Mat& image, const Eigen::Vector2d& near, int reach) {
  double sum = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (int y = int(std::lround(near.y())) - reach; y <= std::lround(near.y()) + reach; ++y) {
    for (int x = int(std::lround(near.x())) - reach; x <= std::lround(near.x()) + reach; ++x) {
      if (x < 0 || y < 0 || x >= image.cols || y >= image.rows) continue;
      const double w = image.at<cv::Vec3b>(y, x)[1];
      sum += w;
      mean += w * Eigen::Vector2d(x, y);
    }
  }
  return mean / sum;
}

struct RigCase {
  const char* name;
  int lens;
  Eigen::Vector3d turn;
  Eigen::Vector3d centre;
  bool rectified;
};

std::vector<Camera> rig(const RigCase& c) {
  std::vector<Camera> cameras(2, test::lens_camera(c.lens));
  cameras[1].fx *= 1.03;
  cameras[1].cx -= 11;
  cameras[0].camera_from_world = test::pose({0.02, -0.01, 0.015}, {0.01, 0, 0});
  const Eigen::Isometry3d pose = test::pose(c.turn, {0, 0, 0});
  cameras[1].camera_from_world = pose;
  cameras[1].camera_from_world.translation() = -(pose.linear() * c.centre);
  return cameras;
}

class Rig : public testing::TestWithParam<std::tuple<RigCase, int>> {};

const RigCase kRigs[] = {
    {"pinhole", 0, {0, 0, 0}, {0.12, 0, 0}, true},
    {"brown4", 4, {0.01, -0.03, 0.02}, {0.12, 0.003, -0.002}, true},
    {"brown5", 5, {0.01, -0.2, 0.02}, {0.12, 0.003, 0}, true},
    {"brown8", 8, {0.01, -0.03, 0.02}, {-0.12, 0.003, 0}, true},
    {"fisheye", -4, {0.01, -0.03, 0.02}, {0.12, 0.003, 0}, true},
    {"vertical", 5, {0.03, 0.01, 0.0}, {0.004, 0.12, 0}, true},
    {"wide5", 5, {0, -0.7, 0.05}, {-0.4, 0, 0.1}, false},
    {"wide_fisheye", -4, {0.1, -0.7, 0.4}, {-0.4, 0, 0.1}, false},
    {"forward", 8, {0, 0, 0}, {0, 0, -0.2}, false},
};

INSTANTIATE_TEST_SUITE_P(Lenses, Rig,
                         testing::Combine(testing::ValuesIn(kRigs), testing::Values(64, 128, 512)),
                         [](const auto& item) {
                           return std::string(std::get<0>(item.param).name) + "_" +
                                  std::to_string(std::get<1>(item.param));
                         });

TEST_P(Rig, ShowsWorldPointsWhereItsTileCamerasSay) {
  const auto& [rig_case, size] = GetParam();
  const std::vector<Camera> cameras = rig(rig_case);
  const Scene scene = box_scene({0.2f, 0.2f, 0.05f});
  const TileMaker tiles(scene, cameras, {.size = size, .padding = 0.2});
  EXPECT_EQ(tiles.rectifies(), rig_case.rectified);

  std::vector<Eigen::Vector3d> points;
  for (const double x : {-0.09, 0.0, 0.09}) {
    for (const double y : {-0.09, 0.0, 0.09})
      points.emplace_back(x + 0.03, y - 0.02, 0.6 - 0.3 * x);
  }
  // Small in the image, so that the lens does not bend it, and two pixels wide in the tile.
  const double sigma = size > 64 ? 3 : 5;
  Frame frame;
  for (const Camera& camera : cameras) {
    cv::Mat image = black(camera);
    for (const Eigen::Vector3d& p : points) draw_dot(image, project(camera, p), sigma);
    frame.views.push_back({image, {}});
  }
  const Observation seen = tiles.make(frame, at(0.03, -0.02, 0.6));
  ASSERT_EQ(seen.views.size(), 2u);
  EXPECT_EQ(seen.rectified, rig_case.rectified);
  for (std::size_t i = 0; i < 2; ++i) {
    const TileView& view = seen.views[i];
    ASSERT_EQ(view.color.size(), cv::Size(size, size));
    ASSERT_EQ(view.color.type(), CV_8UC3);
    ASSERT_EQ(view.valid.size(), cv::Size(size, size));
    EXPECT_TRUE(view.mask.empty());
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector2d expected = project(view.camera, p);
      const Eigen::Vector2d found = centre_of_mass(view.color, expected, size > 128 ? 25 : 6);
      EXPECT_LT((found - expected).norm(), size == 128 ? 0.06 : 0.1)
          << "view " << i << ": " << found.transpose() << " instead of " << expected.transpose();
    }
  }
  if (rig_case.rectified) {
    const TileCamera& a = seen.views[0].camera;
    const TileCamera& b = seen.views[1].camera;
    EXPECT_EQ(a.fx, b.fx);
    EXPECT_EQ(a.fy, b.fy);
    EXPECT_EQ(a.cy, b.cy);
    EXPECT_EQ(a.camera_from_world.linear(), b.camera_from_world.linear());
    const double baseline =
        a.camera_from_world.translation().x() - b.camera_from_world.translation().x();
    for (const Eigen::Vector3d& p : points) {
      const double z = (a.camera_from_world * p).z();
      const double disparity = project(a, p).x() - project(b, p).x();
      EXPECT_NEAR(disparity, a.cx - b.cx + a.fx * baseline / z, 1e-9);
      EXPECT_NEAR(project(a, p).y(), project(b, p).y(), 1e-9);
    }
    EXPECT_GT(baseline, 0);
  }
}

TEST_P(Rig, CoversThePosedSceneWithItsPadding) {
  const auto& [rig_case, size] = GetParam();
  const std::vector<Camera> cameras = rig(rig_case);
  const Scene scene = box_scene({0.2f, 0.1f, 0.05f});
  const TileMaker tiles(scene, cameras, {.size = size, .padding = 0.25});
  Frame frame;
  for (const Camera& camera : cameras) frame.views.push_back({black(camera), {}});
  const Observation seen = tiles.make(frame, at(0, 0, 0.6));
  double fullest = 0;
  for (const TileView& view : seen.views) {
    Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d corner(i & 1 ? 0.1 : -0.1, i & 2 ? 0.05 : -0.05,
                                   0.6 + (i & 4 ? 0.025 : -0.025));
      low = low.min(project(view.camera, corner).array());
      high = high.max(project(view.camera, corner).array());
    }
    const double extent = (high - low).maxCoeff();
    EXPECT_LE(extent, size / 1.5 + 0.01);
    fullest = std::max(fullest, extent);
    const Eigen::Array2d middle = 0.5 * (low + high);
    EXPECT_NEAR(middle.x(), 0.5 * (size - 1), 0.01);
    EXPECT_NEAR(middle.y(), 0.5 * (size - 1), 0.01);
  }
  EXPECT_NEAR(fullest, size / 1.5, 0.01);
}

TEST(Tiles, SmoothBothViewsOfAPairAlike) {
  // The second camera has 1.3 times the resolution; a pixel-wise comparison needs equal blur.
  const Scene scene = box_scene({0.2f, 0.2f, 0.01f});
  std::vector<Camera> cameras(2, test::PlainSetup(1, 64).camera);
  cameras[1].camera_from_world.translation().x() = -0.06;
  const TileMaker tiles(scene, cameras, {.size = 100, .padding = 0.2});
  Frame frame;
  for (const Camera& camera : cameras) {
    cv::Mat image = black(camera);
    const Eigen::Vector2d p = project(camera, {0, 0, 0.6});
    image.colRange(static_cast<int>(std::lround(p.x())), image.cols) = cv::Scalar(200, 200, 200);
    frame.views.push_back({image, {}});
  }
  const Observation seen = tiles.make(frame, at(0, 0, 0.6));
  const auto width_of_edge = [](const cv::Mat& color) {
    int between = 0;
    for (int u = 0; u < color.cols; ++u) {
      const int v = color.at<cv::Vec3b>(50, u)[0];
      between += v > 10 && v < 190;
    }
    return between;
  };
  EXPECT_NEAR(width_of_edge(seen.views[0].color), width_of_edge(seen.views[1].color), 1);
}

TEST(Tiles, WorkForOneViewAndForThree) {
  const Scene scene = box_scene({0.2f, 0.2f, 0.01f});
  std::vector<Camera> cameras;
  Frame frame;
  for (const int lens : {0, 5, -4}) {
    cameras.push_back(test::lens_camera(lens));
    cameras.back().camera_from_world = test::pose({0, 0.1 * lens, 0}, {0, 0, 0.1});
    frame.views.push_back({black(cameras.back()), {}});
    const TileMaker tiles(scene, cameras, {});
    EXPECT_EQ(tiles.make(frame, at(0, 0, 0.5)).views.size(), cameras.size());
  }
}
}  // namespace
}  // namespace hypotrack
