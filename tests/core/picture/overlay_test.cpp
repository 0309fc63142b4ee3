#include "hypotrack/api/overlay.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "render_scenes.hpp"

namespace hypotrack::test {
namespace {

TEST(Overlay, ColoursTheModelsAndLeavesTheRestAlone) {
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

TEST(Overlay, MarksWhereAModelLiesBeforeItself) {
  const Camera camera = camera_at_origin();
  Mesh steps = parallelogram({0, 0, 0.5}, {0.05, 0, 0}, {0, -0.05, 0});  // and half of it nearer
  const Mesh nearer = parallelogram({0.02, 0, 0.45}, {0.02, 0, 0}, {0, -0.04, 0});
  steps.vertices.conservativeResize(3, 8);
  steps.vertices.rightCols(4) = nearer.vertices;
  steps.triangles.conservativeResize(3, 4);
  steps.triangles.rightCols(2) = nearer.triangles.array() + 4;
  steps.bone_indices = Eigen::Matrix4Xi::Zero(4, 8);
  steps.bone_weights = Eigen::Matrix4Xf::Zero(4, 8);
  steps.bone_weights.row(0).setOnes();
  steps.uv.resize(2, 0);
  steps.uv_triangles.resize(3, 0);
  const Scene scene = scene_of({steps});
  const cv::Mat image(camera.height, camera.width, CV_8UC3, cv::Scalar(128, 128, 128));
  Renderer renderer(scene);
  const cv::Mat drawn = draw_overlay(renderer, scene, image, camera, scene.rest_state());
  const Eigen::Vector2d rim = project(camera, {0, 0, 0.45});
  double darkest, brightest;
  cv::Mat green;
  cv::extractChannel(drawn, green, 1);
  cv::minMaxIdx(green(cv::Rect(cvRound(rim.x()) - 2, cvRound(rim.y()), 4, 1)), &darkest,
                &brightest);
  EXPECT_LT(darkest, 0.5 * brightest);
}

TEST(Overlay, OutlinesWithoutFillingAtOpacityZero) {
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
