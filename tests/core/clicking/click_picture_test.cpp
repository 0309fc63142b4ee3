#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "clicked_scene.hpp"
#include "clicking/clicker.hpp"

namespace hypotrack::clicking {
namespace {

TEST(ClickPicture, HasTheViewsSideBySideWithTheFitOverThem) {
  test::ClickedScene world;
  Frame frame;
  for (const int grey : {60, 120})
    frame.views.push_back({.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(grey))});
  Renderer renderer(world.scene);
  Clicker clicker(world.scene, world.cameras, 8);
  const auto draw = [&] {
    return draw_clicks(renderer, world.scene, world.cameras, frame, clicker.drawing());
  };
  const cv::Mat before = draw();
  EXPECT_EQ(before.cols, 1280);
  EXPECT_GT(before.rows, 480);
  EXPECT_EQ(before.at<cv::Vec3b>(100, 20), cv::Vec3b::all(60));
  EXPECT_EQ(before.at<cv::Vec3b>(100, 1260), cv::Vec3b::all(120));
  for (int i = 0; i < 4; ++i) {
    world.click(clicker);
    clicker.press('n');
  }
  ASSERT_TRUE(clicker.fit());
  cv::Mat changed;
  cv::absdiff(draw()(cv::Rect(0, 0, 1280, 480)), before(cv::Rect(0, 0, 1280, 480)), changed);
  for (const std::size_t view : {0, 1}) {
    const Eigen::Vector2d wrist = world.pixel("wrist", view);
    const cv::Rect around(cvRound(wrist.x()) - 10 + (view == 1 ? 640 : 0), cvRound(wrist.y()) - 10,
                          20, 20);
    EXPECT_GT(cv::countNonZero(changed(around).reshape(1)), 100) << "view " << view;
  }
}

}  // namespace
}  // namespace hypotrack::clicking
