// What a tile shows beside colours as they are, and what it refuses.
#include "tile/tiles.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <memory>

#include "box_views.hpp"
#include "hypotrack/api/error.hpp"
#include "test_cameras.hpp"
#include "test_models.hpp"
#include "tile/resample.hpp"
#include "tile_cases.hpp"

namespace hypotrack {
namespace {

using test::at;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Tiles, MarkWhatLiesOutsideTheImage) {
  const test::PlainSetup setup(2, 64);
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
  test::PlainSetup setup(2, 64);
  setup.camera.distortion_model = DistortionModel::brown;
  setup.camera.distortion = {0.0, 0.0, 0.0, 0.0, -1.0};  // r - r^7 falls from r = 0.72 on
  const cv::Mat image(720, 1280, CV_8UC3, cv::Scalar(10, 20, 30));
  // At r = 0.95 the polynomial says 0.29, well inside the image.
  const TileView view = setup.make(image, at(0.95, 0, 1)).views[0];
  EXPECT_EQ(cv::countNonZero(view.valid), 0);
}

TEST(Tiles, OfSeveralRigidModelsAreLargerWhereTheModelsAreApart) {
  const std::shared_ptr<const Model> box = test::box_scene({0.1f, 0.1f, 0.1f}).items()[0].model;
  const Scene two({{"a", box}, {"b", box}});
  Camera camera = test::PlainSetup(1, 64).camera;
  Frame frame;
  frame.views = {{test::black(camera), {}}};
  const auto size_of = [&](const Scene& scene, double apart, double far) {
    Eigen::VectorXd state(14);
    state << at(0, 0, far), at(apart, 0, far);
    const TileMaker maker(scene, {camera}, {.size = 64, .padding = 0.2});
    return maker.plan(frame, state.head(scene.dimension())).header.views[0].camera.width;
  };
  EXPECT_EQ(size_of(two, 0.5, 2), 128);
  EXPECT_EQ(size_of(two, 0.06, 1), 64 + 32);
  EXPECT_EQ(size_of(two, 0, 2), 64);
  EXPECT_EQ(size_of(two, 0.5, 8), 64);  // no finer than the picture
  EXPECT_EQ(size_of(test::box_scene({1, 1, 1}), 0, 2), 64);
  const Scene with_joints({{"a", box}, {"hand", std::make_shared<Model>(test::make_test_hand())}});
  Eigen::VectorXd state = with_joints.rest_state();
  state.head<3>() << 0.5, 0, 2;
  state.segment<3>(7) << 0, 0, 2;
  const TileMaker maker(with_joints, {camera}, {.size = 64, .padding = 0.2});
  EXPECT_EQ(maker.plan(frame, state).header.views[0].camera.width, 64);
}

TEST(Tiles, ResampleTheMaskWithTheColour) {
  for (const double scale : {0.5, 1.0, 1.6, 2.0, 3.3}) {
    const test::PlainSetup setup(scale, 80);
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
  ResamplePlan plan = plan_resampling(camera.lens(), tile, camera.image_size(), 1);
  const TileView before = camera.resample(view, tile, plan);
  plan.colors = {{0.86f, 1.3f, 1.0f}, {0.0f, 40.0f, -70.0f}};
  const TileView after = camera.resample(view, tile, plan);
  for (int i = 0; i < before.color.rows * before.color.cols; ++i) {
    const cv::Vec3b from = before.color.at<cv::Vec3b>(i / before.color.cols, i % before.color.cols);
    const cv::Vec3b to = after.color.at<cv::Vec3b>(i / before.color.cols, i % before.color.cols);
    ASSERT_EQ(to[0], cv::saturate_cast<uchar>(0.86f * from[0]));
    ASSERT_EQ(to[1], cv::saturate_cast<uchar>(1.3f * from[1] + 40));
    ASSERT_EQ(to[2], cv::saturate_cast<uchar>(from[2] - 70));
  }
  EXPECT_EQ(cv::norm(before.mask, after.mask, cv::NORM_INF), 0);
}

TEST(Tiles, SayWhatDoesNotFit) {
  const test::PlainSetup setup(2, 64);
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
