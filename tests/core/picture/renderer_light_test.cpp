#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <set>

#include "hypotrack/api/renderer.hpp"
#include "render_scenes.hpp"

namespace hypotrack::test {
namespace {

/// A wall of one colour at 0.5 m, facing the camera at the origin.
Mesh wall(const Eigen::Vector3f& color = {0.8F, 0.6F, 0.4F}) {
  Mesh mesh = parallelogram({0, 0, 0.5}, {0.1, 0, 0}, {0, -0.1, 0});
  mesh.color = color;
  return mesh;
}

cv::Vec3b center_color(const Scene& scene, const RenderStyle& style) {
  const Camera camera = camera_at_origin();
  const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, style);
  return view.color.at<cv::Vec3b>(cvRound(camera.cy), cvRound(camera.cx));
}

TEST(RendererLight, AmbientOneShowsTheTextureAsItIs) {
  // Blocks of 16x16 texels, wide enough on screen that filtering leaves their centres alone.
  Mesh mesh = wall();
  mesh.texture.create(64, 64, CV_8UC3);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const int block = y / 16 * 4 + x / 16;
      mesh.texture.at<cv::Vec3b>(y, x) = {static_cast<unsigned char>(13 * block + 7),
                                          static_cast<unsigned char>(250 - 11 * block),
                                          static_cast<unsigned char>(31 * block % 256)};
    }
  }
  const Scene scene = scene_of({mesh});
  const Camera camera = camera_at_origin();
  const RenderedView view = Renderer(scene).render(scene.rest_state(), camera, {});
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const Eigen::Vector3d middle((column - 1.5) * 0.05, (row - 1.5) * 0.05, 0.5);
      const Eigen::Vector2d pixel = project(camera, middle);
      EXPECT_EQ(view.color.at<cv::Vec3b>(cvRound(pixel.y()), cvRound(pixel.x())),
                mesh.texture.at<cv::Vec3b>(16 * row + 8, 16 * column + 8))
          << "block in row " << row << ", column " << column << " from the top left";
    }
  }
}

TEST(RendererLight, ShadesByTheCosineOfTheLight) {
  const Scene scene = scene_of({wall()});
  for (const double angle : {0.0, 0.6, 1.2}) {
    const RenderStyle style{
        .ambient = 0.25, .diffuse = 0.5, .light_direction = {std::sin(angle), 0, std::cos(angle)}};
    const double shade = 0.25 + 0.5 * std::cos(angle);
    const cv::Vec3b color = center_color(scene, style);
    EXPECT_NEAR(color[2], 255 * 0.8 * shade, 1);
    EXPECT_NEAR(color[1], 255 * 0.6 * shade, 1);
    EXPECT_NEAR(color[0], 255 * 0.4 * shade, 1);
  }
}

TEST(RendererLight, LeavesWhatFacesAwayToTheAmbientTerm) {
  const RenderStyle style{
      .ambient = 0.25, .diffuse = 0.5, .specular = 0.5, .light_direction = {0, 0, -1}};
  EXPECT_NEAR(center_color(scene_of({wall()}), style)[2], 255 * 0.8 * 0.25, 1);
}

TEST(RendererLight, HighlightsWhereTheLightIsMirrored) {
  const Scene scene = scene_of({wall({0.2F, 0.2F, 0.2F})});
  RenderStyle style{.ambient = 0.5, .specular = 0.4, .light_direction = {0, 0, 1}};
  EXPECT_NEAR(center_color(scene, style)[1], 255 * (0.1 + 0.4), 2);
  style.light_direction = {1, 0, 1};  // half vector at 22.5 degrees
  const double highlight = 0.4 * std::pow(std::cos(M_PI / 8), style.shininess);
  EXPECT_NEAR(center_color(scene, style)[1], 255 * (0.1 + highlight), 2);
}

TEST(RendererLight, DrawsTheEdgesOfABoxSharp) {
  const Scene scene = scene_of({box({0.05F, 0.05F, 0.05F})});
  Eigen::VectorXd state = scene.rest_state();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()));
  state << 0, 0, 0.4, turn.w(), turn.x(), turn.y(), turn.z();
  const RenderStyle style{.ambient = 0.2, .diffuse = 0.8, .samples = 1};
  const RenderedView view = Renderer(scene).render(state, camera_at_origin(), style);
  std::set<int> shades;
  for (int y = 0; y < view.color.rows; ++y) {
    for (int x = 0; x < view.color.cols; ++x) {
      if (view.label.at<unsigned char>(y, x)) shades.insert(view.color.at<cv::Vec3b>(y, x)[1]);
    }
  }
  // Three faces, each of one shade; rounding may split one in two.
  EXPECT_GE(shades.size(), 3U);
  EXPECT_LE(shades.size(), 6U);
  EXPECT_GT(*shades.rbegin() - *shades.begin(), 30);
}

TEST(RendererLight, DrawsACurvedSurfaceSmooth) {
  // A roof of two faces that meet at 20 degrees: smooth, so the shade changes across each face.
  Mesh mesh;
  const auto z = static_cast<float>(0.5 + 0.1 * std::tan(10 * M_PI / 180));
  mesh.vertices.resize(3, 6);
  mesh.vertices << -0.1F, 0, 0.1F, -0.1F, 0, 0.1F,  //
      -0.1F, -0.1F, -0.1F, 0.1F, 0.1F, 0.1F,        //
      z, 0.5F, z, z, 0.5F, z;
  mesh.triangles.resize(3, 4);
  mesh.triangles.transpose() << 0, 3, 1, 1, 3, 4, 1, 4, 2, 2, 4, 5;
  mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, 6);
  mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, 6);
  mesh.bone_weights.row(0).setOnes();
  mesh.color = {1, 1, 1};
  const Scene scene = scene_of({mesh});
  const RenderStyle style{.ambient = 0, .diffuse = 1, .light_direction = {1, 0, 1}};
  const Camera camera = camera_at_origin();
  const cv::Mat color = Renderer(scene).render(scene.rest_state(), camera, style).color;
  const auto shade_at = [&](double x) {
    const Eigen::Vector2d pixel = project(camera, {x, 0, 0.5});
    return int{color.at<cv::Vec3b>(cvRound(pixel.y()), cvRound(pixel.x()))[1]};
  };
  EXPECT_GT(shade_at(-0.08) - shade_at(-0.01), 10);
  EXPECT_GT(shade_at(0.01) - shade_at(0.08), 10);
  EXPECT_NEAR(shade_at(-0.003), shade_at(0.003), 4) << "no step at the ridge";
}

TEST(RendererLight, BlendsEdgesWithTheBackground) {
  const Scene scene = scene_of({wall({1, 1, 1})});
  Camera camera = camera_at_origin();
  camera.camera_from_world.linear() =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const cv::Mat background(camera.height, camera.width, CV_8UC3, cv::Scalar(100, 100, 100));
  const auto levels = [&](int samples) {
    const cv::Mat color =
        Renderer(scene).render(scene.rest_state(), camera, {.samples = samples}, background).color;
    std::set<int> seen;
    for (const auto& pixel : cv::Mat_<cv::Vec3b>(color)) seen.insert(pixel[0]);
    return seen;
  };
  EXPECT_EQ(levels(1), (std::set<int>{100, 255}));
  EXPECT_GE(levels(4).size(), 4U);
  EXPECT_EQ(*levels(4).begin(), 100);
}

}  // namespace
}  // namespace hypotrack::test
