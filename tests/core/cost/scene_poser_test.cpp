#include "scene/scene_poser.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <random>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

/// A box that is moved by code.
class Mover final : public Model {
 public:
  Mover() : Model(test::make_test_box()) {}

 private:
  bool do_poses_itself() const override { return true; }
  void do_pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
               Eigen::Matrix3Xd& landmarks) const override {
    vertices = (world_from_model(parameters).cast<float>() * data().mesh.vertices).eval();
    vertices.row(1) *= 1.5f;
    landmarks.setZero(3, std::ssize(data().landmarks));
  }
};

Scene mixed_scene() {
  return Scene({{"mover", std::make_shared<Mover>()},
                {"hand", std::make_shared<Model>(test::make_test_hand())},
                {"box", std::make_shared<Model>(test::make_test_box())}});
}

Eigen::Matrix3Xf part_vertices(const ScenePoser& poser, const ScenePlan::Part& part) {
  Eigen::Matrix3Xf vertices(3, part.vertex_count);
  for (std::uint32_t i = 0; i < part.vertex_count; ++i) {
    const std::uint32_t at = part.first_vertex + i;
    vertices.col(i) << poser.x()[at], poser.y()[at], poser.z()[at];
  }
  return vertices;
}

TEST(ScenePoser, PosesEveryModelAsItsModelSays) {
  const Scene scene = mixed_scene();
  const ScenePlan plan(scene);
  ScenePoser poser(plan);
  Eigen::Isometry3d camera_from_world(Eigen::Translation3d(0.1, -0.2, 0.05));
  camera_from_world.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  std::mt19937_64 random(2);
  for (int round = 0; round < 5; ++round) {
    const Eigen::VectorXd state = test::random_state(scene, random);
    poser.pose(test::values_of(state), camera_from_world);
    ASSERT_EQ(plan.parts.size(), 3u);
    for (const ScenePlan::Part& part : plan.parts) {
      const Eigen::Matrix3Xf world =
          posed_vertices(*part.item->model, scene.part(*part.item, state));
      ASSERT_EQ(world.cols(), part.vertex_count) << part.item->name;
      const Eigen::Matrix3Xf expected = (camera_from_world * world.cast<double>()).cast<float>();
      const Eigen::Matrix3Xf found = part_vertices(poser, part);
      // Equal up to order: equal extremes and equal sums along several directions.
      for (const Eigen::RowVector3f& axis :
           {Eigen::RowVector3f(1, 0.1f, 0.2f), Eigen::RowVector3f(-0.3f, 1, 0.1f),
            Eigen::RowVector3f(0.2f, -0.4f, 1)}) {
        EXPECT_NEAR((axis * found).minCoeff(), (axis * expected).minCoeff(), 1e-6);
        EXPECT_NEAR((axis * found).maxCoeff(), (axis * expected).maxCoeff(), 1e-6);
        EXPECT_NEAR((axis * found).mean(), (axis * expected).mean(), 1e-6);
        EXPECT_NEAR((axis * found).squaredNorm(), (axis * expected).squaredNorm(), 1e-3);
      }
    }
  }
}

TEST(ScenePoser, FillsUpBlocksWithVerticesOfTheirPart) {
  const Scene scene = mixed_scene();
  const ScenePlan plan(scene);
  ScenePoser poser(plan);
  std::mt19937_64 random(3);
  const Eigen::VectorXd state = test::random_state(scene, random);
  poser.pose(test::values_of(state), Eigen::Isometry3d::Identity());
  int padding = 0;
  for (const ScenePlan::Part& part : plan.parts) {
    const std::uint32_t end = part.first_vertex + part.vertex_count;
    for (std::uint32_t i = end; i % kBlock != 0; ++i, ++padding) {
      EXPECT_EQ(poser.x()[i], poser.x()[end - 1]);
      EXPECT_EQ(poser.y()[i], poser.y()[end - 1]);
      EXPECT_EQ(poser.z()[i], poser.z()[end - 1]);
    }
  }
  EXPECT_GT(padding, 16);
}

TEST(ScenePoser, ShrinksWhatCannotBePosedToTheCamerasCentre) {
  const Scene scene = mixed_scene();
  const ScenePlan plan(scene);
  ScenePoser poser(plan);
  Eigen::VectorXd state = scene.rest_state();
  state[0] = std::numeric_limits<double>::quiet_NaN();  // the mover
  state[scene.items()[1].offset + 10] = 1e7;            // an angle of the hand
  poser.pose(test::values_of(state), Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1)));
  for (const ScenePlan::Part& part : plan.parts) {
    const bool shrunk = part.item->name != "box";
    EXPECT_EQ(part_vertices(poser, part).isZero(0), shrunk) << part.item->name;
  }
}

}  // namespace
}  // namespace hypotrack
