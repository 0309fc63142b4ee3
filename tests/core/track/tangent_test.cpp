#include "track/tangent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "test_models.hpp"

namespace hypotrack {
namespace {

/// Angle between the rotations of two states' model.
double angle_between(const Eigen::VectorXd& a, const Eigen::VectorXd& b, Eigen::Index model) {
  const double cosine = std::abs(a.segment<4>(model + 3).dot(b.segment<4>(model + 3)));
  return 2 * std::acos(std::min(cosine, 1.0));
}

TEST(Tangent, ADifferenceLeadsFromOneStateToTheOther) {
  const Scene scene = test::make_hand_and_box();
  std::mt19937_64 random(1);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd a = test::random_state(scene, random);
    const Eigen::VectorXd b = test::random_state(scene, random);
    const Eigen::VectorXd d = difference(scene, a, b);
    ASSERT_EQ(d.size(), scene.dimension() - 2);
    const Eigen::VectorXd there = moved(scene, a, d);
    for (const Eigen::Index model : {0, 27}) {
      EXPECT_LT(angle_between(there, b, model), 1e-6);
      EXPECT_NEAR(d.segment<3>(model == 0 ? 3 : 29).norm(), angle_between(a, b, model), 1e-7);
      EXPECT_LT((there - b).segment<3>(model).norm(), 1e-12);
    }
    EXPECT_LT((there - b).segment(7, 20).norm(), 1e-12);
  }
}

TEST(Tangent, RotationsTurnTheShorterWay) {
  for (const double angle : {0.0, 1e-9, 0.1, 3.0}) {
    const Eigen::Vector3d v = angle * Eigen::Vector3d(1, 2, -2) / 3;
    Eigen::Quaterniond q = rotation_exp(v);
    EXPECT_LT((rotation_log(q) - v).norm(), 1e-12) << angle;
    q.coeffs() *= -1;
    EXPECT_LT((rotation_log(q) - v).norm(), 1e-12) << angle;
  }
  const Eigen::Vector3d longer(0, 4, 0);
  EXPECT_NEAR(rotation_log(rotation_exp(longer)).y(), 4 - 2 * std::numbers::pi, 1e-12);
}

TEST(Tangent, AnglesStayWithinTheirBounds) {
  const Scene scene = test::make_hand_and_box();
  const Eigen::VectorXd rest = scene.rest_state();
  Eigen::VectorXd d = Eigen::VectorXd::Zero(scene.dimension() - 2);
  d.segment(6, 20).setConstant(10);
  const Eigen::VectorXd there = moved(scene, rest, d);
  for (Eigen::Index i = 7; i < 27; ++i) {
    EXPECT_EQ(there[i], scene.parameters()[static_cast<std::size_t>(i)].upper);
  }
}

TEST(Tangent, PartsCoverEveryNumberOnce) {
  const Scene scene = test::make_hand_and_box();
  Eigen::Index at = 0;
  std::vector<ParameterKind> kinds;
  for (const TangentPart& part : tangent_parts(scene)) {
    EXPECT_EQ(part.first, at);
    at += part.size;
    kinds.push_back(part.kind);
  }
  EXPECT_EQ(at, scene.dimension() - 2);
  using enum ParameterKind;
  EXPECT_EQ(kinds, (std::vector{position, quaternion, angle, position, quaternion}));
}

TEST(Tangent, PartsTellAnglesFromLengths) {
  const Scene scene({{"cabinet", std::make_shared<Model>(test::make_test_cabinet())}});
  const std::vector<TangentPart> parts = tangent_parts(scene);
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(parts[2].kind, ParameterKind::length);
  EXPECT_EQ(parts[2].first, 6);
  EXPECT_EQ(parts[2].size, 1);
  EXPECT_EQ(parts[3].kind, ParameterKind::angle);
  EXPECT_EQ(parts[3].first, 7);
  EXPECT_EQ(parts[3].size, 2);
}

}  // namespace
}  // namespace hypotrack
