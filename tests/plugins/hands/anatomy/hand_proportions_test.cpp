#include "hand_proportions.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "hypotrack/plugin/shape.hpp"

namespace hypotrack {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kScale = 0, kThumb = 1, kIndex = 2, kMiddle = 3, kLittle = 5, kWidth = 6;

std::vector<ShapeParameter> of_a_hand() {
  std::vector<ShapeParameter> all;
  for (const char* name : {"scale", "thumb", "index", "middle", "ring", "little", "width"})
    all.push_back({.name = name});
  return all;
}

MatrixXd correlations_of(std::vector<ShapeParameter> parameters) {
  correlate_as_people(parameters);
  return shape_correlations(parameters);
}

/// What a shape costs whose parameters are this many deviations off.
double cost(const VectorXd& off) { return off.dot(correlations_of(of_a_hand()).inverse() * off); }

TEST(HandProportions, AreADistribution) {
  const MatrixXd correlations = correlations_of(of_a_hand());
  EXPECT_EQ(correlations, correlations.transpose());
  EXPECT_EQ(correlations.diagonal(), VectorXd::Ones(7));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(correlations).eigenvalues().minCoeff(), 0.1);
}

TEST(HandProportions, FindFingersOfOneLengthLikelierThanOneThatDiffers) {
  VectorXd all = VectorXd::Zero(7);
  all.segment(kThumb, 5).setOnes();
  for (int finger = kIndex; finger <= kLittle; ++finger)
    EXPECT_LT(cost(all), 0.5 * cost(VectorXd::Unit(7, finger))) << finger;
  EXPECT_LT(cost(VectorXd::Unit(7, kThumb)), cost(VectorXd::Unit(7, kMiddle)));
}

TEST(HandProportions, FindFingersThatGrowAndShrinkByTurnsUnlikely) {
  VectorXd turns = VectorXd::Zero(7);
  turns.segment(kIndex, 4) << 1, -1, 1, -1;
  EXPECT_GT(cost(turns), 4 * 4) << "four independent parameters would cost 4";
}

TEST(HandProportions, LetLargePalmsHaveShortFingers) {
  VectorXd large = VectorXd::Unit(7, kScale), other = large;
  large.segment(kThumb, 5).setConstant(-0.3);
  other.segment(kThumb, 5).setConstant(0.3);
  EXPECT_LT(cost(large), cost(other));
  EXPECT_LT(cost(large), cost(VectorXd::Unit(7, kScale)));
}

TEST(HandProportions, LetLongFingersBeThick) {
  VectorXd thick = VectorXd::Zero(7), thin = thick;
  thick.segment(kThumb, 5).setOnes();
  thin = thick;
  thick[kWidth] = 0.4;
  thin[kWidth] = -0.4;
  EXPECT_LT(cost(thick), cost(thin));
}

TEST(HandProportions, AreTheSameInAnyOrder) {
  std::vector<ShapeParameter> parameters = of_a_hand();
  const MatrixXd before = correlations_of(parameters);
  std::ranges::reverse(parameters);
  EXPECT_EQ(correlations_of(parameters), before.reverse());
}

TEST(HandProportions, LeaveOtherParametersIndependent) {
  const std::vector<ShapeParameter> can = {{.name = "scale"}, {.name = "height"}, {.name = "lid"}};
  EXPECT_EQ(correlations_of(can), MatrixXd::Identity(3, 3));
}

}  // namespace
}  // namespace hypotrack
