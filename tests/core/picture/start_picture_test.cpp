#include "picture/start_picture.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "render_scenes.hpp"

namespace hypotrack::test {
namespace {

/// Two grey views of a square half a metre away.
class StartPictureTest : public testing::Test {
 protected:
  StartPictureTest() {
    cameras_ = {camera_at_origin(), camera_at_origin()};
    cameras_[1].camera_from_world.translation().x() = -0.06;
    for (const Camera& camera : cameras_)
      frame_.views.push_back(
          {.color = cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar::all(128))});
  }
  cv::Mat draw(const Eigen::VectorXd& state, std::vector<bool> hidden = {}) const {
    return draw_start(scene_, cameras_, {}, frame_,
                      {.state = state, .hidden = std::move(hidden), .caption = {"start: test"}});
  }
  cv::Mat view(const cv::Mat& picture, int i) const {
    const int width = cameras_[0].width;
    return picture(cv::Rect(i * width, 0, width, cameras_[0].height));
  }
  static int changed(const cv::Mat& view) {
    cv::Mat one;
    cv::extractChannel(view, one, 1);
    return view.rows * view.cols - cv::countNonZero(one == 128);
  }

  Scene scene_ = scene_of({parallelogram({0.02, 0, 0.5}, {0.05, 0, 0}, {0, -0.05, 0})});
  std::vector<Camera> cameras_;
  Frame frame_;
};

TEST_F(StartPictureTest, HasTheModelInBothViewsAndACaptionBelow) {
  const cv::Mat picture = draw(scene_.rest_state());
  EXPECT_EQ(picture.cols, 2 * cameras_[0].width);
  EXPECT_GT(picture.rows, cameras_[0].height + 20);
  for (const int i : {0, 1}) {
    const Eigen::Vector2d middle =
        project(cameras_[static_cast<std::size_t>(i)], {0.035, 0.015, 0.5});
    EXPECT_NE(view(picture, i).at<cv::Vec3b>(cvRound(middle.y()), cvRound(middle.x())),
              cv::Vec3b::all(128));
  }
}

TEST_F(StartPictureTest, OutlinesTheTileInBothViews) {
  const TileMaker tiles(scene_, cameras_, {});
  const TilePlan plan = tiles.plan(frame_, scene_.rest_state());
  const cv::Mat picture = draw(scene_.rest_state());
  for (const int i : {0, 1}) {
    const TileCamera& tile = plan.header.views[static_cast<std::size_t>(i)].camera;
    const Eigen::Vector3d left_edge =
        tile.camera_from_world.inverse() * Eigen::Vector3d((-0.5 - tile.cx) / tile.fx, 0.03, 1);
    const Eigen::Vector2d at = project(cameras_[static_cast<std::size_t>(i)], left_edge);
    const cv::Vec3b drawn = view(picture, i).at<cv::Vec3b>(cvRound(at.y()), cvRound(at.x()));
    EXPECT_GT(drawn[1], 170) << "view " << i;
  }
}

TEST_F(StartPictureTest, HasEpipolarLinesInTheSecondViewOnly) {
  const cv::Mat picture = draw(scene_.rest_state());
  // The row of two corners in a rectified pair, left of the model and its tile.
  const Eigen::Vector2d corner = project(cameras_[1], {0.02, 0.05, 0.5});
  const cv::Rect beside(2, cvRound(corner.y()) - 1, 12, 3);
  EXPECT_EQ(changed(view(picture, 0)(beside)), 0);
  EXPECT_GT(changed(view(picture, 1)(beside)), 12);
}

TEST_F(StartPictureTest, IsBareWithoutAState) {
  const cv::Mat picture = draw({});
  EXPECT_EQ(changed(view(picture, 0)), 0);
  EXPECT_EQ(changed(view(picture, 1)), 0);
}

TEST_F(StartPictureTest, SaysSoIfTheModelIsBehindACamera) {
  Eigen::VectorXd state = scene_.rest_state();
  state[2] = -1;
  const cv::Mat picture = draw(state);
  EXPECT_EQ(changed(view(picture, 0)), 0);
  EXPECT_GT(picture.rows, draw({}).rows) << "two more lines of text";
}

}  // namespace
}  // namespace hypotrack::test
