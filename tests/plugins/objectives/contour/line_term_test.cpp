#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "box_pictures.hpp"
#include "jacobian_contract.hpp"
#include "terms.hpp"
#include "test_models.hpp"
#include "written_residuals.hpp"

namespace hypotrack::contour {
namespace {

RenderedHypothesis hypothesis(const Eigen::VectorXd& state) { return {test::values_of(state), {}}; }

TEST(LineTerm, JacobianIsThatOfTheResiduals) {
  BoxPictures& pictures = box_pictures();
  const auto objective = pictures.objective();
  const Observation seen = pictures.seen(pictures.state(), pictures.state());
  objective->prepare(seen);
  ASSERT_GT(objective->residual_count(), 200);
  std::mt19937_64 random(1);
  contract::check_jacobian(*objective, pictures.scene(), hypothesis(pictures.state()), "at it");
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd state = test::random_state(pictures.scene(), random);
    contract::check_jacobian(*objective, pictures.scene(), hypothesis(state), "anywhere");
  }
}

TEST(DepthTerm, JacobianIsThatOfTheResiduals) {
  BoxPictures& pictures = box_pictures();
  const auto lines = pictures.objective(), objective = pictures.objective(0.002);
  const Observation seen = pictures.seen(pictures.state(), pictures.state());
  lines->prepare(seen);
  objective->prepare(seen);
  ASSERT_GT(objective->residual_count(), lines->residual_count() + 200);
  std::mt19937_64 random(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd state = test::random_state(pictures.scene(), random);
    contract::check_jacobian(*objective, pictures.scene(), hypothesis(state), "anywhere");
    const double squares =
        test::sum_of_squares(test::written_residuals(*objective, hypothesis(state)));
    EXPECT_NEAR(squares, objective->cost(hypothesis(state)), 1e-4 * squares);
  }
}

TEST(LineTerm, CostIsTheSumOfSquares) {
  BoxPictures& pictures = box_pictures();
  const auto objective = pictures.objective();
  objective->prepare(pictures.seen(pictures.state(), pictures.state()));
  std::mt19937_64 random(2);
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd state = test::random_state(pictures.scene(), random);
    const double squares =
        test::sum_of_squares(test::written_residuals(*objective, hypothesis(state)));
    EXPECT_NEAR(squares, objective->cost(hypothesis(state)), 1e-4 * squares);
  }
}

/// Returns what outlines tell of pictures whose second camera is turned by an angle.
CameraTurn turn_of(double angle, double displaced) {
  BoxPictures& pictures = box_pictures();
  const auto objective = pictures.objective();
  Observation seen =
      pictures.seen(pictures.state(), pictures.displaced({0, 0, displaced}, {0, 0, 0}));
  TileCamera& second = seen.views[1].camera;  // as a calibration has it that lacks the turn
  const Eigen::Isometry3d back(Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY()));
  second.camera_from_world = back * second.camera_from_world;
  objective->prepare(seen);
  const Eigen::VectorXd state = objective->refined_start();
  return objective->camera_turn(test::values_of(state)).value();
}

TEST(CameraTurns, AreToldByTheOutlinesOfBothViews) {
  constexpr double kTurn = 0.01;
  EXPECT_NEAR(turn_of(0, 0).angle, 0, 0.1 * kTurn);
  EXPECT_NEAR(turn_of(kTurn, 0).angle, kTurn, 0.4 * kTurn);
  EXPECT_NEAR(turn_of(-kTurn, 0.01).angle, -kTurn, 0.4 * kTurn);
  const CameraTurn turn = turn_of(kTurn, 0);
  EXPECT_NEAR(turn.distance, 0.5, 0.05);
  EXPECT_LT(turn.sigma, 0.5 * kTurn);
}

TEST(CameraTurns, AreNotToldByOneView) {
  BoxPictures& pictures = box_pictures();
  const auto objective = pictures.objective();
  Observation seen = pictures.seen(pictures.state(), pictures.state());
  seen.views.resize(1);
  objective->prepare(seen);
  const Eigen::VectorXd state = pictures.state();
  EXPECT_FALSE(objective->camera_turn(test::values_of(state)));
}

TEST(LineTerm, IsBoundedAndTheSameBehindTheCamera) {
  LineSet set{.camera = {100, 100, 100, 100, 50, 50, Eigen::Isometry3d::Identity()},
              .weight = 0.25,
              .reach = 10,
              .lines = {{{0, 0, 0}, {50, 50}, {1, 0}, 0, 4}}};
  const auto cost = [&](double x, double z) {
    const double state[] = {x, 0, z, 1, 0, 0, 0};
    return cost_and_residuals({&set, 1}, state, {});
  };
  EXPECT_NEAR(cost(0.01, 1), 0.25 * 1 / 4 / (1 + 0.01), 1e-9);  // one pixel off
  const double most = 0.25 * 100 / 4;
  EXPECT_LT(cost(5, 1), most);
  EXPECT_GT(cost(5, 1), 0.99 * most);
  EXPECT_NEAR(cost(0, -1), most, 1e-9);
  EXPECT_NEAR(cost(0, 0), most, 1e-9);
}

}  // namespace
}  // namespace hypotrack::contour
