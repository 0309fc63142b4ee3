#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "render/overlay.hpp"
#include "render_scenes.hpp"

namespace hypotrack::test {
namespace {

TEST(Overlay, colours_the_models_and_leaves_the_rest_alone) {
  const Camera camera = camera_at_origin();
  const Scene scene = scene_of({parallelogram({-0.06, 0, 0.5}, {0.05, 0, 0}, {0, -0.05, 0}),
                                parallelogram({0.06, 0, 0.5}, {0.05, 0, 0}, {0, -0.05, 0})});
  const cv::Mat image(camera.height, camera.width, CV_8UC3, cv::Scalar(128, 128, 128));
  Renderer renderer(scene);
  const cv::Mat drawn = draw_overlay(renderer, scene, image, camera, scene.rest_state());
  const auto at = [&](double x) {
    const Eigen::Vector2d pixel = project(camera, {x, 0, 0.5});
    return drawn.at<cv::Vec3b>(cvRound(pixel.y()), cvRound(pixel.x()));
  };
  EXPECT_GT(at(-0.06)[0], at(-0.06)[2] + 40) << "the first model is teal";
  EXPECT_GT(at(0.06)[2], at(0.06)[0] + 40) << "the second model is orange";
  EXPECT_EQ(drawn.at<cv::Vec3b>(10, 10), cv::Vec3b(128, 128, 128));
  EXPECT_EQ(image.at<cv::Vec3b>(120, 120), cv::Vec3b(128, 128, 128)) << "the input is not touched";
}

TEST(Overlay, outlines_without_filling_at_opacity_zero) {
  const Camera camera = camera_at_origin();
  const Scene scene = scene_of({parallelogram({0, 0, 0.5}, {0.05, 0, 0}, {0, -0.05, 0})});
  const cv::Mat image(camera.height, camera.width, CV_8UC3, cv::Scalar(128, 128, 128));
  Renderer renderer(scene);
  const cv::Mat drawn =
      draw_overlay(renderer, scene, image, camera, scene.rest_state(), {.opacity = 0});
  const Eigen::Vector2d middle = project(camera, {0, 0, 0.5}),
                        edge = project(camera, {0.05, 0, 0.5});
  EXPECT_EQ(drawn.at<cv::Vec3b>(cvRound(middle.y()), cvRound(middle.x())),
            cv::Vec3b(128, 128, 128));
  const cv::Vec3b outline = drawn.at<cv::Vec3b>(cvRound(edge.y()), static_cast<int>(edge.x()));
  EXPECT_GT(cv::norm(cv::Vec3i(outline), cv::Vec3i(128, 128, 128)), 60);
}

}  // namespace
}  // namespace hypotrack::test
