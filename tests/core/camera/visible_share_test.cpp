#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"
#include "tile/tiles.hpp"

namespace hypotrack {
namespace {

/// A camera with a lens: 0 pinhole, 8 Brown's, 14 with thin prisms and a tilted sensor, -4 fisheye.
Camera lens_camera(int coefficients, double x, double turn) {
  Camera camera{640, 480, 500, 505, 321.5, 237.5, DistortionModel::none, {}, {}};
  camera.camera_from_world.setIdentity();
  camera.camera_from_world.rotate(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()));
  camera.camera_from_world.translate(Eigen::Vector3d(-x, 0.01 * x, 0));
  if (coefficients > 0) {
    camera.distortion_model = DistortionModel::brown;
    camera.distortion = {-0.28, 0.09, 0.0012, -0.0007, -0.012, 0.02, 0.011, -0.004};
    const std::vector<double> more = {0.03, -0.01, -0.02, 0.01, 0.08, -0.1};
    if (coefficients > 8)
      camera.distortion.insert(camera.distortion.end(), more.begin(), more.end());
  } else if (coefficients < 0) {
    camera.distortion_model = DistortionModel::fisheye;
    camera.distortion = {-0.02, 0.011, -0.006, 0.0013};
  }
  return camera;
}

/// Every vertex by itself, in double precision.
double reference(const Scene& scene, const std::vector<Camera>& cameras,
                 const Eigen::VectorXd& state) {
  double visible = 0;
  double all = 0;
  for (const auto& item : scene.items()) {
    const Eigen::Matrix3Xf vertices = posed_vertices(*item.model, scene.part(item, state));
    for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
      bool in_all = true;
      for (const Camera& camera : cameras) {
        const Eigen::Vector2d p = project(camera, vertices.col(i).cast<double>());
        if (!p.allFinite()) return 0;
        in_all = in_all && p.x() >= -0.5 && p.y() >= -0.5 && p.x() < camera.width - 0.5 &&
                 p.y() < camera.height - 0.5;
      }
      visible += in_all;
      ++all;
    }
  }
  return visible / all;
}

TEST(VisibleShare, CountsTheVerticesThatEveryImageShows) {
  const Scene scene = test::make_hand_and_box();
  std::mt19937_64 random(4);
  int partly = 0;
  for (const int lens : {0, 8, 14, -4}) {
    const std::vector<Camera> cameras = {lens_camera(lens, 0, 0.02), lens_camera(lens, 0.1, -0.1)};
    const TileMaker tiles(scene, cameras, {});
    for (int i = 0; i < 100; ++i) {
      const Eigen::VectorXd state = test::random_state(scene, random, {0.05, 0, 0.5}, 0.35);
      const double expected = reference(scene, cameras, state);
      // A vertex within rounding of the border may fall on either side.
      EXPECT_NEAR(tiles.visible_share(state), expected, 1.5 / 1508) << lens;
      partly += expected > 0.05 && expected < 0.95;
    }
  }
  EXPECT_GT(partly, 30);
}

TEST(VisibleShare, IsNothingIfAnyVertexLiesBehindACamera) {
  const Scene scene = test::make_hand_and_box();
  const std::vector<Camera> cameras = {lens_camera(0, 0, 0)};
  const TileMaker tiles(scene, cameras, {});
  Eigen::VectorXd state = scene.rest_state();
  for (const auto& item : scene.items()) state[item.offset + 2] = 0.5;
  EXPECT_GT(tiles.visible_share(state), 0.5);
  state[2] = 0.01;  // the box reaches behind the camera, the hand does not
  EXPECT_EQ(tiles.visible_share(state), 0);
}

TEST(VisibleShare, IsNothingIfAnyVertexIsTooNearForATile) {
  const Scene scene({{"box", std::make_shared<Model>(test::make_test_box())}});
  const TileMaker tiles(scene, {lens_camera(0, 0, 0)}, {});
  Eigen::VectorXd state = scene.rest_state();
  state[2] = 1;
  const Eigen::Matrix3Xf vertices =
      posed_vertices(*scene.items()[0].model, scene.part(scene.items()[0], state));
  const double nearest = 1 - static_cast<double>(vertices.row(2).minCoeff());
  state[2] = nearest + 0.002;  // metres
  EXPECT_GT(tiles.visible_share(state), 0);
  state[2] = nearest + 0.0005;
  EXPECT_EQ(tiles.visible_share(state), 0);
}

TEST(VisibleShare, IsOneWhereEverythingIsSeen) {
  const Scene scene({{"box", std::make_shared<Model>(test::make_test_box())}});
  const std::vector<Camera> cameras = {lens_camera(8, 0, 0), lens_camera(8, 0.1, 0)};
  const TileMaker tiles(scene, cameras, {});
  Eigen::VectorXd state = scene.rest_state();
  state[2] = 0.6;
  EXPECT_EQ(tiles.visible_share(state), 1);
}

}  // namespace
}  // namespace hypotrack
