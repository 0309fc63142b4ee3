#include "track/prediction.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "test_models.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

constexpr double kPeriod = 1 / 30.0;

struct PredictedHand {
  Scene scene{{{"hand", std::make_shared<Model>(test::make_test_hand())}}};

  /// A hand `metres` along x, turned by `radians` about y, every finger joint at `angle`.
  Eigen::VectorXd state(double metres, double radians, double angle = 0.1) const {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(scene.dimension() - 1);
    d[0] = metres;
    d[4] = radians;
    d.tail(20).setConstant(angle);
    return moved(scene, scene.rest_state(), d);
  }
  Predictor make(Prediction velocity, double gain = 0.5) const {
    return Predictor(scene, {.velocity = velocity, .gain = gain});
  }
};

TEST(Predictor, ExpectsTheGivenShareOfTheLastMotion) {
  const PredictedHand f;
  Predictor predictor = f.make(Prediction::constant, 0.7);
  predictor.add(f.state(0, 0.2, 0.10), 0);
  predictor.add(f.state(0.010, 0.3, 0.12), kPeriod);
  const Eigen::MatrixXd expected = predictor.at(2 * kPeriod);
  ASSERT_EQ(expected.cols(), 1);
  EXPECT_LT((expected - f.state(0.017, 0.37, 0.134)).norm(), 1e-12);
}

TEST(Predictor, OffersNoneHalfAndAllOfTheMotionOfPosesAndAngles) {
  const PredictedHand f;
  Predictor predictor = f.make(Prediction::adaptive);
  predictor.add(f.state(0, 0, 0.10), 0);
  predictor.add(f.state(0.010, 0.1, 0.12), kPeriod);
  const Eigen::MatrixXd offered = predictor.at(2 * kPeriod);
  ASSERT_EQ(offered.cols(), 9);
  EXPECT_LT((offered.col(0) - f.state(0.015, 0.15, 0.13)).norm(), 1e-12) << "the middle one first";
  for (const double pose : {0.0, 0.5, 1.0}) {
    for (const double angle : {0.0, 0.5, 1.0}) {
      const auto wanted = f.state(0.010 + 0.010 * pose, 0.1 + 0.1 * pose, 0.12 + 0.02 * angle);
      int found = 0;
      for (const auto& state : offered.colwise()) found += (state - wanted).norm() < 1e-12;
      EXPECT_EQ(found, 1) << pose << " of the pose, " << angle << " of the angles";
    }
  }
}

TEST(Predictor, KnowsThatMotionTakesTime) {
  const PredictedHand f;
  Predictor predictor = f.make(Prediction::constant, 1);
  predictor.add(f.state(0, 0), 0);
  predictor.add(f.state(0.010, 0), 0.02);
  EXPECT_NEAR(predictor.at(0.06)(0, 0), 0.030, 1e-12);
}

TEST(Predictor, ExpectsNothingAcrossLongGaps) {
  const PredictedHand f;
  Predictor predictor = f.make(Prediction::constant, 1);
  const double longest = PredictionSettings().longest_gap;
  predictor.add(f.state(0, 0), 0);
  predictor.add(f.state(0.010, 0.1), kPeriod);
  EXPECT_EQ(predictor.at(kPeriod + 0.99 * longest).cols(), 1);
  EXPECT_EQ(predictor.at(kPeriod + 1.01 * longest).cols(), 0);
  EXPECT_EQ(predictor.at(kPeriod).cols(), 0) << "no time has passed";
  predictor.add(f.state(0.050, 0), 0.5);  // no motion follows from a step across a gap
  EXPECT_EQ(predictor.at(0.5 + kPeriod).cols(), 0);
}

TEST(Predictor, ExpectsNothingWhereNoMotionIsKnown) {
  const PredictedHand f;
  for (const Prediction velocity : {Prediction::none, Prediction::constant, Prediction::adaptive}) {
    Predictor predictor = f.make(velocity);
    EXPECT_EQ(predictor.at(0).cols(), 0);
    predictor.add(f.state(0.01, 0.1), 0);
    EXPECT_EQ(predictor.at(kPeriod).cols(), 0);
    predictor.add(f.state(0.02, 0.2), kPeriod);
    EXPECT_EQ(predictor.at(2 * kPeriod).cols() > 0, velocity != Prediction::none);
    predictor.forget_motion();
    EXPECT_EQ(predictor.at(2 * kPeriod).cols(), 0);
  }
}

}  // namespace
}  // namespace hypotrack
