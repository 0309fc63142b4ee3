// What deviations from detected landmarks cost, with a detector that is always right.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "expect_error.hpp"
#include "hands_in_view.hpp"
#include "hypotrack/api/error.hpp"
#include "jacobian_contract.hpp"
#include "test_models.hpp"

namespace hypotrack::landmarks {
namespace {

using test::bent;
using test::hypothesis;
using test::relaxed;
using ::testing::HasSubstr;

class LandmarksCost : public ::testing::Test {
 protected:
  LandmarksCost() { prepare(); }

  void prepare() {
    sees_.seen = test::observation(start_, ++frame_);
    objective_ = std::make_unique<Landmarks>(params_, test::two_hands(), sees_.detector());
    objective_->prepare(sees_.seen);
  }
  double cost(const Eigen::VectorXd& state) const { return objective_->cost(hypothesis(state)); }
  Eigen::VectorXf residuals(const Eigen::VectorXd& state) const {
    Eigen::VectorXf out = Eigen::VectorXf::Constant(objective_->residual_count(), NAN);
    objective_->write_residuals(hypothesis(state),
                                {out.data(), static_cast<std::size_t>(out.size())});
    return out;
  }

  Eigen::VectorXd start_ = relaxed();
  test::SeesState sees_{relaxed()};
  LandmarksParams params_;
  std::unique_ptr<Landmarks> objective_;
  int frame_ = 0;
};

TEST_F(LandmarksCost, IsNothingWhereHandsAreDetected) { EXPECT_NEAR(cost(relaxed()), 0, 1e-9); }

TEST_F(LandmarksCost, GrowsWithTheAngleOfAFinger) {
  double before = cost(relaxed());
  for (const double angle : {0.7, 1.0, 1.3}) {
    const double now = cost(bent(relaxed(), "hand.index", angle));
    EXPECT_GT(now, before + 0.02) << angle;
    before = now;
  }
}

TEST_F(LandmarksCost, OfDeviationsWithinTheFreeOnesIsNothing) {
  Eigen::VectorXd state = relaxed();
  state[0] += 0.8 * params_.free;
  EXPECT_NEAR(cost(state), 0, 1e-9);
  state[0] += 0.4 * params_.free;
  EXPECT_GT(cost(state), 1e-3);
}

TEST_F(LandmarksCost, IsHalfOfTheMostWhereAllLandmarksAreOffBySigma) {
  params_.sigma = 0.05;
  params_.free = 0;
  prepare();
  Eigen::VectorXd state = relaxed();
  state[1] += 0.05;
  EXPECT_NEAR(cost(state), 21 / 2.0, 1);
  state[1] += 100;
  EXPECT_NEAR(cost(state), 21, 0.1);
}

TEST_F(LandmarksCost, FallsWithTheDetectorsPresence) {
  const Eigen::VectorXd state = bent(relaxed(), "hand.ring", 1);
  const double sure = cost(state);
  params_.presence_power = 2;
  sees_.presence = 0.6;
  prepare();
  EXPECT_NEAR(cost(state), 0.36 * sure, 1e-9);
}

TEST_F(LandmarksCost, IsTheSumOfTheResidualsSquares) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20; ++i) {
    Eigen::VectorXd state = hypotrack::test::random_state(test::two_hands(), random, {0, 0, 0.5});
    test::two_hands().normalize(state);
    EXPECT_NEAR(residuals(state).squaredNorm(), cost(state), 1e-4);
    std::vector<float> again(static_cast<std::size_t>(objective_->residual_count()));
    EXPECT_EQ(objective_->cost_and_residuals(hypothesis(state), again), cost(state));
    EXPECT_EQ(Eigen::VectorXf::Map(again.data(), objective_->residual_count()), residuals(state));
  }
}

TEST_F(LandmarksCost, HasTheSlopesOfTheResiduals) {
  const Eigen::VectorXd state = bent(bent(relaxed(), "hand.index", 0.9), "left.little", 0.7);
  const Eigen::VectorXf here = residuals(state);
  const auto& parameters = test::two_hands().parameters();
  constexpr double kStep = 1e-4;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].kind == ParameterKind::quaternion) continue;
    Eigen::VectorXd before = state, after = state;
    before[static_cast<Eigen::Index>(i)] -= kStep;
    after[static_cast<Eigen::Index>(i)] += kStep;
    const double of_cost = (cost(after) - cost(before)) / (2 * kStep);
    const Eigen::VectorXf rise = residuals(after) - residuals(before);
    const double of_residuals = double{rise.dot(here)} / kStep;
    EXPECT_NEAR(of_residuals, of_cost, 0.02 * std::abs(of_cost) + 0.01) << parameters[i].name;
  }
}

TEST_F(LandmarksCost, OfAHandBehindTheCameraIsFinite) {
  Eigen::VectorXd state = relaxed();
  for (const double z : {0.0, -1e-12, -0.5, -10.0}) {
    state[2] = z;
    EXPECT_TRUE(std::isfinite(cost(state))) << z;
    EXPECT_TRUE(residuals(state).allFinite()) << z;
  }
}

TEST_F(LandmarksCost, IsNothingWhereNothingIsDetected) {
  sees_.left = sees_.right = false;
  prepare();
  EXPECT_EQ(cost(bent(relaxed(), "hand.index", 1)), 0);
  EXPECT_EQ(residuals(relaxed()), Eigen::VectorXf::Zero(objective_->residual_count()));
}

TEST_F(LandmarksCost, OfALeftHandTakesNoDetectionOfARightOne) {
  sees_.right = false;
  start_.head<3>() = start_.segment<3>(test::two_hands().items()[1].offset);
  prepare();
  EXPECT_EQ(cost(bent(relaxed(), "hand.index", 1)), 0);
  EXPECT_GT(cost(bent(relaxed(), "left.index", 1)), 0.1);
}

TEST_F(LandmarksCost, DoesNotDependOnTheTile) {
  const Eigen::VectorXd state = bent(relaxed(), "left.middle", 1);
  const double before = cost(state);
  sees_.seen = test::observation(start_, ++frame_);
  for (TileView& view : sees_.seen.views) {
    view.camera.fx = view.camera.fy = 150;
    view.camera.cx += 7;
  }
  objective_->prepare(sees_.seen);
  EXPECT_NEAR(cost(state), before, 1e-9);
}

TEST_F(LandmarksCost, IsThatOfTheHandsInSight) {
  sees_.left = false;
  prepare();
  EXPECT_EQ(cost(bent(relaxed(), "left.index", 1)), cost(relaxed()));
  EXPECT_GT(cost(bent(relaxed(), "hand.index", 1)), 0.1);
}

TEST_F(LandmarksCost, HasTheJacobianOfItsResiduals) {
  ASSERT_TRUE(objective_->has_jacobian());
  for (int i = 0; i < 4; ++i) {
    const Eigen::VectorXd off = Eigen::VectorXd::LinSpaced(relaxed().size(), 1, 9 + i);
    Eigen::VectorXd state = relaxed() + 0.05 * off.array().sin().matrix();
    test::two_hands().normalize(state);
    EXPECT_NO_THROW(contract::check_jacobian(*objective_, test::two_hands(), hypothesis(state),
                                             "state " + std::to_string(i)));
  }
  sees_.left = false;
  prepare();
  EXPECT_NO_THROW(
      contract::check_jacobian(*objective_, test::two_hands(), hypothesis(relaxed()), "one hand"));
}

TEST(Landmarks, OfASceneWithoutHandsAreNoneAndNeedNoDetector) {
  const Scene scene({{"box", std::make_shared<Model>(hypotrack::test::make_test_box())}});
  LandmarksParams params;
  params.folder = "/nowhere";
  Landmarks objective(params, scene, networks(params, scene));
  Observation observation = test::observation(scene.rest_state());
  observation.scene = &scene;
  objective.prepare(observation);
  EXPECT_EQ(objective.residual_count(), 0);
  EXPECT_EQ(objective.cost(hypothesis(observation.start)), 0);
}

TEST(Landmarks, NeedAColourImage) {
  test::SeesState sees(relaxed());
  sees.seen = test::observation(relaxed());
  Landmarks objective({}, test::two_hands(), sees.detector());
  sees.seen.views[0].color.release();
  objective.prepare(sees.seen);
  sees.seen.views[1].color.release();
  EXPECT_THAT(hypotrack::test::message_of<DataError>([&] { objective.prepare(sees.seen); }),
              HasSubstr("no view has a colour image"));
}

}  // namespace
}  // namespace hypotrack::landmarks
