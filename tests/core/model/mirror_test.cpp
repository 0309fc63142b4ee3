#include <gtest/gtest.h>

#include <random>

#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

const Eigen::DiagonalMatrix<double, 3> kMirror(-1, 1, 1);

double signed_volume(const Eigen::Matrix3Xf& vertices, const Eigen::Matrix3Xi& triangles) {
  double volume = 0;
  for (const auto& t : triangles.colwise()) {
    const Eigen::Vector3d a = vertices.col(t[0]).cast<double>();
    const Eigen::Vector3d b = vertices.col(t[1]).cast<double>();
    const Eigen::Vector3d c = vertices.col(t[2]).cast<double>();
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

// The root pose seen in the mirror; every other parameter stays.
Eigen::VectorXd mirrored_root(Eigen::VectorXd state) {
  state[0] *= -1;
  state[5] *= -1;
  state[6] *= -1;
  return state;
}

TEST(Mirrored, PosesToTheMirrorImageForAnyParameters) {
  for (const ModelData& data : {test::make_test_hand(), test::make_test_cabinet()}) {
    const auto right = std::make_shared<const Model>(data);
    const Model left(mirrored(right->data()));
    const Scene scene({{"it", right}});
    std::mt19937_64 random(1);
    for (int i = 0; i < 20; ++i) {
      const Eigen::VectorXd state = test::random_state(scene, random);
      const Eigen::VectorXd reflected = mirrored_root(state);
      const Eigen::Matrix3Xf vertices = posed_vertices(left, test::values_of(reflected));
      Eigen::Matrix3Xf expected = posed_vertices(*right, test::values_of(state));
      expected.row(0) *= -1;
      EXPECT_LT((vertices - expected).cwiseAbs().maxCoeff(), 1e-6f);
      const Eigen::Matrix3Xd landmarks = posed_landmarks(left, test::values_of(reflected));
      EXPECT_LT((landmarks - kMirror * posed_landmarks(*right, test::values_of(state)))
                    .cwiseAbs()
                    .maxCoeff(),
                1e-12);
    }
  }
}

TEST(Mirrored, KeepsTheOutsideOutside) {
  const ModelData right = test::make_test_hand();
  const ModelData left = mirrored(right);
  const double volume = signed_volume(right.mesh.vertices, right.mesh.triangles);
  EXPECT_GT(volume, 0);
  EXPECT_NEAR(signed_volume(left.mesh.vertices, left.mesh.triangles), volume, 1e-9);
}

TEST(Mirrored, KeepsTextureCornersWithTheirVertices) {
  ModelData right = test::make_test_box();
  right.mesh.uv = Eigen::Matrix2Xf::Random(2, 8).cwiseAbs();
  right.mesh.uv_triangles = right.mesh.triangles;  // corner i has texture coordinate i
  const ModelData left = mirrored(right);
  EXPECT_EQ(left.mesh.uv_triangles, left.mesh.triangles);
  EXPECT_EQ(left.mesh.uv, right.mesh.uv);
}

TEST(Mirrored, KeepsNamesAndBounds) {
  const ModelData right = test::make_test_hand();
  const ModelData left = mirrored(right);
  ASSERT_EQ(left.parameters.size(), right.parameters.size());
  for (std::size_t i = 0; i < left.parameters.size(); ++i) {
    EXPECT_EQ(left.parameters[i].name, right.parameters[i].name);
    EXPECT_EQ(left.parameters[i].lower, right.parameters[i].lower);
    EXPECT_EQ(left.parameters[i].upper, right.parameters[i].upper);
  }
}

TEST(Mirrored, TwiceIsTheModelItself) {
  const ModelData once = test::make_test_hand();
  const ModelData twice = mirrored(mirrored(once));
  EXPECT_EQ(twice.mesh.vertices, once.mesh.vertices);
  EXPECT_EQ(twice.mesh.triangles, once.mesh.triangles);
  for (std::size_t i = 0; i < once.motions.size(); ++i) {
    EXPECT_EQ(twice.motions[i].axis, once.motions[i].axis);
  }
}

}  // namespace
}  // namespace hypotrack
