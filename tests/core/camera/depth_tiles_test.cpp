#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <memory>
#include <opencv2/calib3d.hpp>

#include "hypotrack/api/error.hpp"
#include "test_cameras.hpp"
#include "test_models.hpp"
#include "tile/resample.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Scene box_scene() {
  return Scene({{"box", std::make_shared<Model>(test::make_test_box({0.2, 0.2, 0.05}))}});
}

Camera pinhole() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 320.3;
  camera.cy = 239.6;
  return camera;
}

/// The tile of a pinhole camera that does not turn, `scale` image pixels per pixel.
TileCamera tile_of(const Camera& camera, double scale, int size = 64) {
  TileCamera tile;
  tile.width = tile.height = size;
  tile.fx = tile.fy = camera.fx / scale;
  tile.cx = tile.cy = 0.5 * (size - 1) + 0.123;
  return tile;
}

cv::Mat random_depth(const Camera& camera, std::uint64_t seed) {
  cv::Mat depth(camera.height, camera.width, CV_32F);
  cv::RNG random(seed);
  random.fill(depth, cv::RNG::UNIFORM, 0.3, 0.9);
  return depth;
}

TileView resampled(const Camera& camera, const TileCamera& tile, const View& view) {
  const Resampler resampler(camera, Eigen::Matrix3d::Identity());
  const double scale = scale_at_centre(resampler.lens(), tile);
  return resampler.resample(view, tile,
                            plan_resampling(resampler.lens(), tile, resampler.image_size(), scale));
}

TEST(DepthTiles, AreThatOfTheNearestPixelAtAnyScale) {
  const Camera camera = pinhole();
  const cv::Mat depth = random_depth(camera, 3);
  for (const double scale : {0.21, 0.5, 0.97, 1.0, 1.31, 2.0, 3.4}) {
    const TileCamera tile = tile_of(camera, scale);
    const TileView view = resampled(camera, tile, {.depth = depth});
    ASSERT_EQ(view.depth.type(), CV_32FC1);
    int compared = 0;
    for (int v = 0; v < tile.height; ++v) {
      for (int u = 0; u < tile.width; ++u) {
        const double x = (u - tile.cx) * scale + camera.cx;
        const double y = (v - tile.cy) * scale + camera.cy;
        const auto clear = [](double a) { return std::abs(a - std::floor(a) - 0.5) > 1e-3; };
        if (!clear(x) || !clear(y)) continue;  // between two pixels either is right
        const float expected =
            depth.at<float>(static_cast<int>(std::lround(y)), static_cast<int>(std::lround(x)));
        ASSERT_EQ(view.depth.at<float>(v, u), expected) << u << ", " << v << " at " << scale;
        ++compared;
      }
    }
    EXPECT_GT(compared, 0.95 * tile.width * tile.height);
  }
}

TEST(DepthTiles, AreZeroOutsideTheImageAndWhereNothingWasMeasured) {
  const Camera camera = pinhole();
  cv::Mat depth(camera.height, camera.width, CV_32F, cv::Scalar(0.5));
  depth.at<float>(240, 320) = 0;
  depth.at<float>(240, 321) = std::numeric_limits<float>::quiet_NaN();
  depth.at<float>(240, 322) = std::numeric_limits<float>::infinity();
  depth.at<float>(240, 323) = -0.5f;
  TileCamera tile = tile_of(camera, 1);
  tile.cx = camera.cx - 300;  // tile pixel 0 is image column 300
  tile.cy = camera.cy - 230;
  const TileView middle = resampled(camera, tile, {.depth = depth});
  EXPECT_EQ(cv::countNonZero(middle.depth), 64 * 64 - 4);
  for (int u = 20; u < 24; ++u) EXPECT_EQ(middle.depth.at<float>(10, u), 0) << u;

  tile.cx = camera.cx - 600;
  const TileView edge = resampled(camera, tile, {.depth = depth});
  for (int u = 0; u < 64; ++u) EXPECT_EQ(edge.depth.at<float>(10, u), u < 40 ? 0.5f : 0) << u;
  EXPECT_EQ(cv::countNonZero((edge.depth > 0) != (edge.valid > 0)), 0);

  tile.cx = camera.cx - 6000;
  const TileView nothing = resampled(camera, tile, {.depth = depth});
  ASSERT_EQ(nothing.depth.size(), cv::Size(64, 64));
  EXPECT_EQ(cv::countNonZero(nothing.depth), 0);
}

TEST(DepthTiles, OfAViewWithoutColourHaveNoColour) {
  const Camera camera = pinhole();
  const TileCamera tile = tile_of(camera, 1.7);
  View view{.depth = random_depth(camera, 4)};
  EXPECT_TRUE(resampled(camera, tile, view).color.empty());
  EXPECT_TRUE(resampled(camera, tile, view).mask.empty());
  EXPECT_EQ(cv::countNonZero(resampled(camera, tile, view).valid), 64 * 64);
  view.mask = cv::Mat(camera.height, camera.width, CV_8U, cv::Scalar(1));
  EXPECT_TRUE(resampled(camera, tile, view).color.empty());
  EXPECT_EQ(cv::countNonZero(resampled(camera, tile, view).mask), 64 * 64);
  EXPECT_TRUE(resampled(camera, tile, {.color = cv::Mat(480, 640, CV_8UC3)}).depth.empty());
}

/// The plane through `point` with `normal`, as a camera with a lens measures it.
cv::Mat depth_of_plane(const Camera& camera, const Eigen::Vector3d& point,
                       const Eigen::Vector3d& normal) {
  std::vector<cv::Point2f> pixels, ideal;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) pixels.emplace_back(x, y);
  }
  const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::undistortPoints(pixels, ideal, k, camera.distortion);
  const Eigen::Vector3d n = camera.camera_from_world.linear() * normal;
  const double distance = n.dot(camera.camera_from_world * point);
  cv::Mat depth(camera.height, camera.width, CV_32F);
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    const auto z = static_cast<float>(distance / n.dot(Eigen::Vector3d(ideal[i].x, ideal[i].y, 1)));
    depth.at<float>(static_cast<int>(i) / camera.width, static_cast<int>(i) % camera.width) = z;
  }
  return depth;
}

TEST(DepthTiles, AreAlongTheTilesAxisWhereThePairIsRectified) {
  // Two cameras turned by some 9 degrees against the axis they share once rectified, and rolled.
  std::vector<Camera> cameras = {test::lens_camera(0), test::lens_camera(5)};
  cameras[0].camera_from_world = test::pose({0.03, 0.15, 0.1}, {0.01, 0, 0});
  cameras[1].camera_from_world =
      test::pose({-0.05, -0.15, -0.04}, {0, 0, 0}) * Eigen::Translation3d(-0.12, 0.01, 0.004);
  const Eigen::Vector3d point(0.02, 0.01, 0.6);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, 1).normalized();
  const Scene scene = box_scene();
  const TileMaker tiles(scene, cameras, {.size = 96, .padding = 0.2});
  ASSERT_TRUE(tiles.rectifies());
  Frame frame;
  for (const Camera& camera : cameras) {
    frame.views.push_back({.depth = depth_of_plane(camera, point, normal)});
  }
  Eigen::VectorXd state = scene.rest_state();
  state.head<3>() = point;
  const Observation seen = tiles.make(frame, state);
  for (std::size_t i = 0; i < 2; ++i) {
    const TileView& view = seen.views[i];
    const Eigen::Isometry3d& pose = view.camera.camera_from_world;
    EXPECT_GT(std::acos((pose.linear() * cameras[i].camera_from_world.linear().transpose())(2, 2)),
              0.1);
    const Eigen::Vector3d n = pose.linear() * normal;
    int measured = 0;
    for (int v = 0; v < 96; ++v) {
      for (int u = 0; u < 96; ++u) {
        const float z = view.depth.at<float>(v, u);
        if (z == 0) continue;
        const Eigen::Vector3d ray((u - view.camera.cx) / view.camera.fx,
                                  (v - view.camera.cy) / view.camera.fy, 1);
        // The nearest pixel is up to half a pixel away along a slanted plane: 1/700 x slope x z.
        EXPECT_NEAR(z, n.dot(pose * point) / n.dot(ray), 6e-4) << u << ", " << v;
        ++measured;
      }
    }
    EXPECT_GT(measured, 96 * 96 / 2);
  }
}

TEST(DepthTiles, SayWhatDoesNotFit) {
  const Scene scene = box_scene();
  const TileMaker tiles(scene, {pinhole()}, {});
  Eigen::VectorXd state = scene.rest_state();
  state.head<3>() = Eigen::Vector3d(0, 0, 1);
  const auto make = [&](const View& view) {
    Frame frame;
    frame.index = 3;
    frame.views = {view};
    tiles.make(frame, state);
  };
  EXPECT_THAT([&] { make({}); },
              ThrowsMessage<DataError>(HasSubstr(
                  "frame 3, view 0: there is neither colour nor depth; expected at least one")));
  EXPECT_THAT(
      [&] { make({.depth = cv::Mat(240, 320, CV_32F)}); },
      ThrowsMessage<DataError>(HasSubstr("the depth image is 320x240 pixels, its camera 640x480")));
  EXPECT_THAT([&] { make({.depth = cv::Mat(480, 640, CV_16U)}); },
              ThrowsMessage<DataError>(HasSubstr("the depth image is of OpenCV type CV_16UC1; "
                                                 "expected metres as 32-bit floats")));
}

}  // namespace
}  // namespace hypotrack
