#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/rectification.hpp"
#include "geometry/resample.hpp"
#include "geometry/tiles.hpp"
#include "hypotrack/error.hpp"
#include "test_cameras.hpp"
#include "tile_cases.hpp"

namespace hypotrack {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A scene of one box of the given size (metres) around its own origin.
Scene box_scene(const Eigen::Vector3f& size) {
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.col(i) =
        0.5f * size.cwiseProduct(Eigen::Vector3f(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  }
  mesh.triangles.resize(3, 12);
  mesh.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      3, 2, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                //
      1, 3, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, 8);
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, 8);
  mesh.bone_weights.row(0).setOnes();
  return Scene({{"box", std::make_shared<Model>(rigid_model(mesh))}});
}

Eigen::VectorXd at(double x, double y, double z) {
  Eigen::VectorXd state(7);
  state << x, y, z, 1, 0, 0, 0;
  return state;
}

Eigen::Vector2d project(const TileCamera& camera, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p = camera.camera_from_world * p_world;
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

cv::Mat black(const Camera& camera) { return cv::Mat::zeros(camera.height, camera.width, CV_8UC3); }

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

TEST(Resampler, MapsAsOpenCvsUndistortionDoes) {
  const Eigen::Matrix3d turn = test::pose({0.05, 0.1, -0.03}, {0, 0, 0}).linear();
  cv::Matx33d r;  // OpenCV's R takes the camera's axes to the ideal ones
  for (int i = 0; i < 9; ++i) r.val[i] = turn.transpose()(i / 3, i % 3);
  TileCamera tile;
  tile.width = tile.height = 100;
  tile.fx = tile.fy = 180;
  tile.cx = 90;
  tile.cy = 20;
  for (const int lens : {0, 4, 5, 8, -4}) {
    const Camera camera = test::lens_camera(lens);
    const cv::Matx33d k(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Matx33d k_tile(tile.fx, 0, tile.cx, 0, tile.fy, tile.cy, 0, 0, 1);
    cv::Mat x, y;
    if (lens < 0) {
      cv::fisheye::initUndistortRectifyMap(k, camera.distortion, r, k_tile, {100, 100}, CV_32F, x,
                                           y);
    } else {
      cv::initUndistortRectifyMap(k, camera.distortion, r, k_tile, {100, 100}, CV_32F, x, y);
    }
    const Resampler resampler(camera, turn);
    const ImageMap map = resampler.map(tile);
    const cv::Rect inner(1, 1, 100, 100);
    EXPECT_LT(cv::norm(map.x(inner), x, cv::NORM_INF), 2e-3) << lens;
    EXPECT_LT(cv::norm(map.y(inner), y, cv::NORM_INF), 2e-3) << lens;
    EXPECT_NEAR(scale_at_centre(resampler.lens(), tile), 700.0 / 180, 0.4) << lens;
  }
}

/// A view of a pinhole camera and a box that makes a tile `scale` times coarser than the image.
struct PlainSetup {
  PlainSetup(double scale, int size)
      : scene(box_scene(Eigen::Vector3f(1, 1, 1e-6f) * static_cast<float>(scale * size / 700))) {
    camera.width = 1280;
    camera.height = 720;
    camera.fx = camera.fy = 700;
    camera.cx = 640 - 0.5;
    camera.cy = 360 - 0.5;
    settings = {.size = size, .padding = 0};
  }
  Observation make(const cv::Mat& image, const Eigen::VectorXd& state = at(0, 0, 1),
                   const cv::Mat& mask = {}) const {
    Frame frame;
    frame.index = 7;
    frame.time = 0.25;
    frame.views = {{image, mask}};
    return TileMaker(scene, {camera}, settings).make(frame, state);
  }
  Scene scene;
  Camera camera;
  TileSettings settings;
};

TEST(Tiles, AreTheImageItselfWhereNothingChanges) {
  const PlainSetup setup(1, 128);
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
    const PlainSetup setup(factor, 64);
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
    const PlainSetup setup(scale, 100);
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
    const PlainSetup setup(scale, 90);
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

TEST(Tiles, MarkWhatLiesOutsideTheImage) {
  const PlainSetup setup(2, 64);
  const double shift = (640.0 - 10.0) / 700;  // most of the tile is right of the image
  const cv::Mat image(720, 1280, CV_8UC3, cv::Scalar(10, 20, 30));
  const TileView view = setup.make(image, at(shift, 0, 1)).views[0];
  int inside = 0;
  for (int v = 0; v < 64; ++v) {
    for (int u = 0; u < 64; ++u) {
      const double x = (u - view.camera.cx) / view.camera.fx * 700 + setup.camera.cx;
      EXPECT_EQ(view.valid.at<uchar>(v, u) != 0, x < 1279.5) << x;
      EXPECT_EQ(view.color.at<cv::Vec3b>(v, u), cv::Vec3b(10, 20, 30));
      inside += view.valid.at<uchar>(v, u) != 0;
    }
  }
  EXPECT_GT(inside, 0);
  EXPECT_LT(inside, 64 * 64);
  const TileView nothing = setup.make(image, at(5, 0, 1)).views[0];
  EXPECT_EQ(cv::countNonZero(nothing.valid), 0);
  EXPECT_EQ(nothing.color.size(), cv::Size(64, 64));
}

TEST(Tiles, DoNotShowWhatTheLensFoldsBackIntoTheImage) {
  PlainSetup setup(2, 64);
  setup.camera.distortion_model = DistortionModel::brown;
  setup.camera.distortion = {0.0, 0.0, 0.0, 0.0, -1.0};  // r - r^7 falls from r = 0.72 on
  const cv::Mat image(720, 1280, CV_8UC3, cv::Scalar(10, 20, 30));
  // At r = 0.95 the polynomial says 0.29, well inside the image.
  const TileView view = setup.make(image, at(0.95, 0, 1)).views[0];
  EXPECT_EQ(cv::countNonZero(view.valid), 0);
}

TEST(Tiles, CutTheMaskWithTheColour) {
  for (const double scale : {0.5, 1.0, 1.6, 2.0, 3.3}) {
    const PlainSetup setup(scale, 80);
    const cv::Mat image(720, 1280, CV_8UC3, cv::Scalar(10, 20, 30));
    cv::Mat mask = cv::Mat::zeros(720, 1280, CV_8U);
    mask.colRange(645, 1280) = 1;  // any non-zero number is foreground
    const TileView view = setup.make(image, at(0, 0, 1), mask).views[0];
    ASSERT_EQ(view.mask.type(), CV_8U);
    for (int u = 0; u < 80; ++u) {
      const double x = (u - view.camera.cx) / view.camera.fx * 700 + setup.camera.cx;
      if (std::abs(x - 644.5) < 0.5 * scale + 0.1) continue;
      EXPECT_EQ(view.mask.at<uchar>(40, u) != 0, x > 644.5) << x << " at scale " << scale;
    }
  }
}

TEST(Tiles, ShowMappedColoursWithinTheirRange) {
  const Eigen::Matrix3d straight = Eigen::Matrix3d::Identity();
  const View view = test::noise_view(test::lens_camera(0), true, true, false);
  const TileCamera tile = test::tile_towards(straight, {0.1, 0.05, 1}, 1);
  const Resampler camera(test::lens_camera(0), straight);
  CutPlan plan = plan_cut(camera.lens(), tile, camera.image_size(), 1);
  const TileView before = camera.cut(view, tile, plan);
  plan.colors = {{0.86f, 1.3f, 1.0f}, {0.0f, 40.0f, -70.0f}};
  const TileView after = camera.cut(view, tile, plan);
  for (int i = 0; i < before.color.rows * before.color.cols; ++i) {
    const cv::Vec3b from = before.color.at<cv::Vec3b>(i / before.color.cols, i % before.color.cols);
    const cv::Vec3b to = after.color.at<cv::Vec3b>(i / before.color.cols, i % before.color.cols);
    ASSERT_EQ(to[0], cv::saturate_cast<uchar>(0.86f * from[0]));
    ASSERT_EQ(to[1], cv::saturate_cast<uchar>(1.3f * from[1] + 40));
    ASSERT_EQ(to[2], cv::saturate_cast<uchar>(from[2] - 70));
  }
  EXPECT_EQ(cv::norm(before.mask, after.mask, cv::NORM_INF), 0);
}

TEST(Tiles, SmoothBothViewsOfAPairAlike) {
  // The second camera has 1.3 times the resolution; a pixel-wise comparison needs equal blur.
  const Scene scene = box_scene({0.2f, 0.2f, 0.01f});
  std::vector<Camera> cameras(2, PlainSetup(1, 64).camera);
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

TEST(Tiles, SayWhatDoesNotFit) {
  const PlainSetup setup(2, 64);
  const TileMaker tiles(setup.scene, {setup.camera}, setup.settings);
  Frame frame;
  frame.index = 3;
  EXPECT_THAT([&] { tiles.make(frame, at(0, 0, 1)); },
              ThrowsMessage<DataError>(HasSubstr("frame 3 has 0 views; expected 1")));
  frame.views = {{cv::Mat::zeros(480, 640, CV_8UC3), {}}};
  EXPECT_THAT(
      [&] { tiles.make(frame, at(0, 0, 1)); },
      ThrowsMessage<DataError>(HasSubstr("the image is 640x480 pixels, its camera 1280x720")));
  frame.views = {{cv::Mat::zeros(720, 1280, CV_8U), {}}};
  EXPECT_THAT([&] { tiles.make(frame, at(0, 0, 1)); },
              ThrowsMessage<DataError>(HasSubstr("expected 8-bit BGR")));
  frame.views = {{cv::Mat::zeros(720, 1280, CV_8UC3), cv::Mat::zeros(10, 10, CV_8U)}};
  EXPECT_THAT([&] { tiles.make(frame, at(0, 0, 1)); },
              ThrowsMessage<DataError>(HasSubstr("the mask is 10x10")));
  frame.views[0].mask.release();
  EXPECT_THAT([&] { tiles.make(frame, at(0, 0, -1)); },
              ThrowsMessage<DataError>(HasSubstr("model 'box' lies at or behind camera 0")));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(tiles.make(frame, at(nan, 0, 1)), DataError);
  EXPECT_THAT([&] { TileMaker(setup.scene, {}, setup.settings); },
              ThrowsMessage<DataError>(HasSubstr("no cameras")));
  Camera broken = setup.camera;
  broken.fx = 0;
  EXPECT_THAT([&] { TileMaker(setup.scene, {broken}, setup.settings); },
              ThrowsMessage<DataError>(HasSubstr("camera 0: the focal lengths")));
}

}  // namespace
}  // namespace hypotrack
