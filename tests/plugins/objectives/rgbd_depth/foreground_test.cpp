#include "foreground.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "depth_scene.hpp"
#include "foreground-inl.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/params.hpp"
#include "test_models.hpp"

namespace hypotrack::rgbd_depth {
namespace {

const cv::Vec3b kSkin{105, 172, 224}, kDarkSkin{45, 60, 90}, kGrey{120, 120, 120},
    kBlue{200, 80, 30};

// Top row: measured at 0.2, 0.45, 0.55 and 0.9 m; second row: not measured. The left half skin, the
// right half grey. The mask: the second and third column.
TileView mixed_view() {
  TileView view = blank_view(4);
  view.depth.at<float>(0, 0) = 0.2f;
  view.depth.at<float>(0, 1) = 0.45f;
  view.depth.at<float>(0, 2) = 0.55f;
  view.depth.at<float>(0, 3) = 0.9f;
  view.color = cv::Mat3b(4, 4, kGrey);
  view.color.colRange(0, 2).setTo(cv::Scalar(kSkin));
  view.mask = cv::Mat1b(4, 4, uchar{0});
  view.mask.colRange(1, 3).setTo(1);
  return view;
}

constexpr DepthRange kRange{0.4, 0.6};

std::vector<float> row(const ObservedView& view, int y) {
  return {view.pixels.row(y), view.pixels.row(y) + 4};
}
using Row = std::vector<float>;

TEST(Foreground, ByMaskIsTheMaskWithAndWithoutDepth) {
  const ObservedView v = observe(mixed_view(), Foreground::mask, kRange);
  EXPECT_EQ(row(v, 0), (Row{kBackground, 0.45f, 0.55f, kBackground}));
  EXPECT_EQ(row(v, 1), (Row{kBackground, kUnmeasured, kUnmeasured, kBackground}));
  EXPECT_EQ(v.foreground, 8);
  EXPECT_EQ(v.measured, 2);
}

TEST(Foreground, ByMaskDoesNotLookAtTheRange) {
  const ObservedView v = observe(mixed_view(), Foreground::mask, {5, 6});
  EXPECT_EQ(row(v, 0), (Row{kBackground, 0.45f, 0.55f, kBackground}));
}

TEST(Foreground, ByDepthIsWhatWasMeasuredWithinTheRange) {
  const ObservedView v = observe(mixed_view(), Foreground::depth, kRange);
  EXPECT_EQ(row(v, 0), (Row{kBackground, 0.45f, 0.55f, kBackground}));
  EXPECT_EQ(row(v, 1), Row(4, kBackground));
  EXPECT_EQ(v.foreground, 2);
  EXPECT_EQ(v.measured, 2);
}

TEST(Foreground, BySkinNeedsTheColourAndNoDepthOutsideTheRange) {
  const ObservedView v = observe(mixed_view(), Foreground::skin, kRange);
  EXPECT_EQ(row(v, 0), (Row{kBackground, 0.45f, kBackground, kBackground}));
  EXPECT_EQ(row(v, 1), (Row{kUnmeasured, kUnmeasured, kBackground, kBackground}));
  EXPECT_EQ(v.foreground, 7);
  EXPECT_EQ(v.measured, 1);
}

TEST(Foreground, AutoIsTheMaskWhereThereIsOneAndDepthOtherwise) {
  TileView view = mixed_view();
  EXPECT_EQ(observe(view, Foreground::automatic, kRange).foreground, 8);
  view.mask.release();
  EXPECT_EQ(observe(view, Foreground::automatic, kRange).foreground, 2);
}

TEST(Foreground, ImagesThatItsWayDoesNotNeedMayBeMissingOrOfAnotherKind) {
  TileView view = mixed_view();
  view.color = cv::Mat1b(1, 1);
  EXPECT_EQ(observe(view, Foreground::mask, kRange).foreground, 8);
  view.color.release();
  view.mask.release();
  EXPECT_EQ(observe(view, Foreground::depth, kRange).foreground, 2);
  view.color = cv::Mat3b(4, 4, kSkin);
  view.color.release();  // of a type, but without pixels
  EXPECT_EQ(observe(view, Foreground::depth, kRange).foreground, 2);
}

TEST(Foreground, OutsideOfTheImageThereIsNone) {
  TileView view = mixed_view();
  view.valid.col(1).setTo(0);
  for (const auto way : {Foreground::mask, Foreground::depth, Foreground::skin}) {
    const ObservedView v = observe(view, way, kRange);
    for (int y = 0; y < 4; ++y) EXPECT_EQ(v.pixels.row(y)[1], kOutside);
  }
  EXPECT_EQ(observe(view, Foreground::mask, kRange).foreground, 4);
}

TEST(Foreground, RangeIsThatOfTheSurfacesAlongTheCamerasAxis) {
  TileCamera camera = blank_view(4).camera;
  DepthRange range = depth_range(box_scene(), box_state(), camera, 0.1);
  EXPECT_NEAR(range.nearest, 0.34, 1e-6);  // the box is 120 mm deep, half a metre away
  EXPECT_NEAR(range.farthest, 0.66, 1e-6);
  camera.camera_from_world.translation().z() = 0.25;
  range = depth_range(box_scene(), box_state(), camera, 0);
  EXPECT_NEAR(range.nearest, 0.69, 1e-6);
  EXPECT_NEAR(range.farthest, 0.81, 1e-6);
  // From the side the box is 60 mm deep.
  camera.camera_from_world = Eigen::AngleAxisd(90 * kDegree, Eigen::Vector3d::UnitY()) *
                             Eigen::Translation3d(-0.7, 0, -0.5);
  range = depth_range(box_scene(), box_state(), camera, 0);
  EXPECT_NEAR(range.nearest, 0.67, 1e-6);
  EXPECT_NEAR(range.farthest, 0.73, 1e-6);
}

TEST(Foreground, RangeIsThatOfTheReferenceForABentHand) {
  const Scene scene({{"hand", std::make_shared<Model>(test::make_test_hand())}});
  std::mt19937_64 random(3);
  const TileCamera camera = blank_view(4).camera;
  for (int i = 0; i < 10; ++i) {
    const Eigen::VectorXd state = test::random_state(scene, random);
    const Eigen::Matrix3Xf posed =
        posed_vertices(*scene.items()[0].model, scene.part(scene.items()[0], state));
    const DepthRange range = depth_range(scene, state, camera, 0.01);
    EXPECT_NEAR(range.nearest, posed.row(2).minCoeff() - 0.01, 1e-6);
    EXPECT_NEAR(range.farthest, posed.row(2).maxCoeff() + 0.01, 1e-6);
  }
}

bool is_skin(const cv::Vec3b& bgr) { return rgbd_depth::is_skin(bgr[0], bgr[1], bgr[2]); }

TEST(Skin, IsLightAndDarkSkinAndNothingElse) {
  EXPECT_TRUE(is_skin(kSkin));
  EXPECT_TRUE(is_skin(kDarkSkin));
  for (const auto& other : {kGrey, kBlue, cv::Vec3b{255, 255, 255}, cv::Vec3b{0, 0, 0},
                            cv::Vec3b{40, 180, 60}, cv::Vec3b{0, 0, 255}}) {
    EXPECT_FALSE(is_skin(other)) << other;
  }
}

TEST(Skin, IsTheBoxInOpenCvsYCrCbForEveryColour) {
  for (int blue = 0; blue < 256; ++blue) {
    cv::Mat3b colors(256, 256), ycrcb;
    for (int y = 0; y < 256; ++y)
      for (int x = 0; x < 256; ++x) colors(y, x) = cv::Vec3b(cv::Vec3i(blue, y, x));
    cv::cvtColor(colors, ycrcb, cv::COLOR_BGR2YCrCb);
    cv::Mat1b expected;
    cv::inRange(ycrcb, cv::Scalar(0, 133, 77), cv::Scalar(255, 173, 127), expected);
    int different = 0;
    for (int y = 0; y < 256; ++y)
      for (int x = 0; x < 256; ++x) different += is_skin(colors(y, x)) != (expected(y, x) != 0);
    ASSERT_EQ(different, 0) << "blue " << blue;
  }
}

}  // namespace
}  // namespace hypotrack::rgbd_depth
