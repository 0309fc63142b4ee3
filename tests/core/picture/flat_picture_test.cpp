#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>

#include "hypotrack/api/overlay.hpp"
#include "hypotrack/api/renderer.hpp"
#include "render_scenes.hpp"

namespace hypotrack::test {
namespace {

/// Two boxes, turned, the first in front of the second.
struct World {
  World() : scene(scene_of({box({0.1F, 0.06F, 0.05F}), box({0.12F, 0.12F, 0.02F})})) {
    state = scene.rest_state();
    state << 0.02, 0.01, 0.5, 0.9, 0.3, 0.2, 0.1, -0.05, 0, 0.7, 1, 0.2, -0.3, 0;
    scene.normalize(state);
  }
  Scene scene;
  Eigen::VectorXd state;
};

/// The share of pixels with another label or a depth that differs by more than 1 %.
double differing_share(const RenderedView& a, const RenderedView& b) {
  int different = 0;
  for (int y = 0; y < a.label.rows; ++y)
    for (int x = 0; x < a.label.cols; ++x) {
      const float one = a.depth.at<float>(y, x), other = b.depth.at<float>(y, x);
      different += a.label.at<unsigned char>(y, x) != b.label.at<unsigned char>(y, x) ||
                   std::abs(one - other) > 0.01F * other;
    }
  return different / static_cast<double>(cv::countNonZero(b.label));
}

TEST(FlatPicture, HasTheDepthsAndLabelsOfATexturedOne) {
  const World world;
  Camera camera = camera_at_origin();
  for (const double distortion : {0.0, -0.25}) {
    camera.distortion_model = distortion == 0 ? DistortionModel::none : DistortionModel::brown;
    if (distortion != 0) camera.distortion = {distortion, 0.08, 0.004, -0.006};
    Renderer renderer(world.scene);
    const RenderedView flat = renderer.render(world.state, camera, {.textured = false});
    const RenderedView textured = renderer.render(world.state, camera, {});
    EXPECT_GT(cv::countNonZero(flat.label == 1), 5000);
    EXPECT_GT(cv::countNonZero(flat.label == 2), 1000);
    EXPECT_LT(differing_share(flat, textured), 0.03) << "distortion " << distortion;
  }
}

TEST(FlatPicture, LeavesHiddenModelsOut) {
  const World world;
  const RenderedView view =
      Renderer(world.scene)
          .render(world.state, camera_at_origin(), {.textured = false, .hidden = {true, false}});
  EXPECT_EQ(cv::countNonZero(view.label == 1), 0);
  EXPECT_GT(cv::countNonZero(view.label == 2), 5000);
}

TEST(FlatPicture, ShadesByTheCosineOfTheLight) {
  const Camera camera = camera_at_origin();
  for (const double angle : {0.0, 0.4, 0.9}) {
    const Eigen::Vector3d u(0.1 * std::cos(angle), 0, 0.1 * std::sin(angle));
    const Scene scene = scene_of({parallelogram({0, 0, 0.5}, u, {0, -0.1, 0})});
    const RenderStyle style{
        .ambient = 0.25, .diffuse = 0.5, .light_direction = {0, 0, 1}, .textured = false};
    const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, style);
    const cv::Vec3b color = view.color.at<cv::Vec3b>(cvRound(camera.cy), cvRound(camera.cx));
    EXPECT_NEAR(color[0], 255 * 0.74 * (0.25 + 0.5 * std::cos(angle)), 2) << angle;
  }
}

TEST(FlatPictureDeathTest, NeedsNoOpenGL) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "with a sanitizer the driver is loaded before the program begins";
#endif
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // in a process where nothing was drawn before
  const auto draw = [] {
    const World world;
    Renderer renderer(world.scene);
    const Camera camera = camera_at_origin();
    const cv::Mat image(camera.height, camera.width, CV_8UC3, cv::Scalar(128, 128, 128));
    draw_overlay(renderer, world.scene, image, camera, world.state);
    std::exit(dlopen("libEGL.so.1", RTLD_LAZY | RTLD_NOLOAD) ? 1 : 0);
  };
  EXPECT_EXIT(draw(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace hypotrack::test
