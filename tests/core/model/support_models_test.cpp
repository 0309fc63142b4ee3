// The models that other tests stand on: they keep what their header promises.
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

// Every edge belongs to two triangles that run along it in opposite directions.
void expect_closed(const Eigen::Matrix3Xi& triangles) {
  std::map<std::array<int, 2>, int> edges;
  for (const auto& t : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << edge[0] << " " << edge[1];
    const auto back = edges.find({edge[1], edge[0]});
    ASSERT_TRUE(back != edges.end()) << edge[0] << " " << edge[1];
  }
}

TEST(TestHand, IsAClosedHandOfTheStatedSize) {
  const ModelData hand = test::make_test_hand();
  validate(hand, "test hand");
  EXPECT_EQ(hand.parameters.size(), 27u);
  EXPECT_EQ(hand.bones.size(), 21u);
  EXPECT_EQ(hand.landmarks.size(), 21u);
  EXPECT_EQ(hand.mesh.vertices.cols(), 1500);
  EXPECT_EQ(hand.mesh.triangles.cols(), 2976);
  expect_closed(hand.mesh.triangles);
}

TEST(TestHand, FlexesTowardsThePalmAndAbductsTowardsTheThumb) {
  const Model hand(test::make_test_hand());
  std::vector<double> state(27, 0);
  state[3] = 1;
  const Eigen::Vector3d straight = posed_landmarks(hand, state).col(8);  // index tip
  state[12] = 0.5;
  EXPECT_GT(posed_landmarks(hand, state).col(8).z(), straight.z() + 0.02);
  state[12] = 0;
  state[11] = 0.3;
  EXPECT_GT(posed_landmarks(hand, state).col(8).x(), straight.x() + 0.02);
}

TEST(TestBox, IsAClosedBoxOfTheStatedSize) {
  const ModelData box = test::make_test_box({0.1, 0.2, 0.3});
  validate(box, "test box");
  expect_closed(box.mesh.triangles);
  EXPECT_TRUE(box.mesh.vertices.rowwise().maxCoeff().isApprox(Eigen::Vector3f(0.05f, 0.1f, 0.15f)));
  double volume = 0;
  for (const auto& t : box.mesh.triangles.colwise()) {
    Eigen::Matrix3f corners;
    corners << box.mesh.vertices.col(t[0]), box.mesh.vertices.col(t[1]),
        box.mesh.vertices.col(t[2]);
    volume += corners.determinant() / 6;
  }
  EXPECT_NEAR(volume, 0.006, 1e-8);
}

}  // namespace
}  // namespace hypotrack
