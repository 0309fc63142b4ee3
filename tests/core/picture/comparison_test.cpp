#include "picture/comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>

#include "render_scenes.hpp"

namespace hypotrack::test {
namespace {

constexpr int kLegend = 56;

/// A grey picture of a square whose solution lies to the right of its truth.
class ComparisonTest : public testing::Test {
 protected:
  ScenePose pose(double x) const {
    Eigen::VectorXd state = scene_.rest_state();
    state[0] += x;
    return {state, scene_.landmarks(state)};
  }
  cv::Mat draw(const ScenePose& solution, const ScenePose& truth) {
    const cv::Mat image(camera_.height, camera_.width, CV_8UC3, cv::Scalar(128, 128, 128));
    return draw_comparison(renderer_, image, camera_, solution, truth, "frame 7");
  }
  /// Pixels of the picture above the legend that are about as orange or as blue as what is drawn.
  static int pixels(const cv::Mat& drawn, bool orange) {
    int count = 0;
    for (int y = 0; y < drawn.rows - kLegend; ++y)
      for (int x = 0; x < drawn.cols; ++x) {
        const auto bgr = drawn.at<cv::Vec3b>(y, x);
        count += orange ? bgr[2] > 230 && bgr[0] < 80 : bgr[0] > 230 && bgr[2] < 120;
      }
    return count;
  }

  Camera camera_ = camera_at_origin();
  Scene scene_ = scene_of({parallelogram({0, 0, 0.5}, {0.05, 0, 0}, {0, -0.05, 0})});
  Renderer renderer_{scene_};
};

TEST_F(ComparisonTest, ShowsBothEnlargedOverALegend) {
  const cv::Mat drawn = draw(pose(0.02), pose(0));
  EXPECT_EQ(std::max(drawn.cols, drawn.rows - kLegend), 640);
  EXPECT_GT(pixels(drawn, true), 500);
  EXPECT_GT(pixels(drawn, false), 500);
  const cv::Vec3b corner = drawn.at<cv::Vec3b>(2, 2);
  EXPECT_EQ(corner, cv::Vec3b(128, 128, 128)) << "there is room around them";
}

TEST_F(ComparisonTest, TintsTheSolutionOnly) {
  const cv::Mat drawn = draw(pose(0.02), {});
  const int row = (drawn.rows - kLegend) / 2 + 40;
  const auto middle = drawn.at<cv::Vec3b>(row, drawn.cols / 2 + 40);
  EXPECT_GT(middle[2], middle[0] + 30);
  EXPECT_EQ(pixels(drawn, false), 0);
}

TEST_F(ComparisonTest, DrawsATruthOfWhichOnlyLandmarksAreKnown) {
  ScenePose truth = pose(0);
  truth.state.resize(0);
  const int with_all = pixels(draw(pose(0.02), truth), false);
  EXPECT_GT(with_all, 0);
  truth.landmarks.col(0).setConstant(std::numeric_limits<double>::quiet_NaN());
  const int with_one_unknown = pixels(draw(pose(0.02), truth), false);
  EXPECT_GT(with_one_unknown, 0);
  EXPECT_LT(with_one_unknown, with_all);
}

TEST_F(ComparisonTest, ShowsTheWholeImageWhereNothingIsInView) {
  ScenePose away = pose(0);
  away.state[2] = -1;
  away.landmarks = scene_.landmarks(away.state);
  const cv::Mat drawn = draw(away, away);
  EXPECT_NEAR(static_cast<double>(drawn.cols) / (drawn.rows - kLegend),
              static_cast<double>(camera_.width) / camera_.height, 0.01);
}

}  // namespace
}  // namespace hypotrack::test
