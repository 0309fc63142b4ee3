#include "track/one_euro.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "test_models.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

constexpr double kFrame = 1 / 30.0;

struct SmoothedHand {
  Scene scene{{{"hand", std::make_shared<Model>(test::make_test_hand())}}};
  OneEuroSettings settings;

  /// The hand at rest, moved.
  Eigen::VectorXd state(const Eigen::Vector3d& position, const Eigen::Vector3d& turn,
                        double angle) const {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(scene.dimension() - 1);
    d << position, turn, Eigen::VectorXd::Constant(20, angle);
    return moved(scene, scene.rest_state(), d);
  }
};

TEST(OneEuro, PassesTheFirstStateOn) {
  const SmoothedHand f;
  OneEuroFilter filter(f.scene, f.settings);
  const Eigen::VectorXd state = f.state({0.1, 0.2, 0.5}, {0.3, 0, 0}, 0.2);
  EXPECT_EQ(filter.filter(state, 3.0), state);
}

TEST(OneEuro, SteadiesAHandAtRest) {
  const SmoothedHand f;
  OneEuroFilter filter(f.scene, f.settings);
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  const auto vector = [&](double sigma) {
    return Eigen::Vector3d(sigma * normal(random), sigma * normal(random), sigma * normal(random));
  };
  double before = 0, after = 0;
  const Eigen::VectorXd rest = f.state({0, 0, 0}, {0, 0, 0}, 0.3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::VectorXd noisy = f.state(vector(0.001), vector(0.01), 0.3 + 0.02 * normal(random));
    const Eigen::VectorXd smooth = filter.filter(noisy, i * kFrame);
    if (i < 20) continue;
    before += difference(f.scene, rest, noisy).squaredNorm();
    after += difference(f.scene, rest, smooth).squaredNorm();
  }
  EXPECT_LT(after, 0.3 * before);
}

TEST(OneEuro, LagsLittleBehindAHandThatMoves) {
  const SmoothedHand f;
  OneEuroFilter filter(f.scene, f.settings);
  double lag = 0, turn_lag = 0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.02 * i, turn = 0.05 * i;  // 0.6 m/s, 1.5 rad/s
    const Eigen::VectorXd smooth = filter.filter(f.state({x, 0, 0}, {0, turn, 0}, 0), i * kFrame);
    const Eigen::VectorXd d = difference(f.scene, smooth, f.state({x, 0, 0}, {0, turn, 0}, 0));
    lag = d.head<3>().norm();
    turn_lag = d.segment<3>(3).norm();
    EXPECT_NEAR(smooth.segment<4>(3).norm(), 1, 1e-12);
  }
  EXPECT_LT(lag, 0.005) << "a quarter of a frame's motion";
  EXPECT_LT(turn_lag, 0.05) << "a frame's";
}

TEST(OneEuro, ARotationComesOutAsOneWhereverItsSignIs) {
  const SmoothedHand f;
  OneEuroFilter filter(f.scene, f.settings);
  for (int i = 0; i < 30; ++i) {
    Eigen::VectorXd state = f.state({0, 0, 0.5}, {0, 0.02 * i, 0}, 0);
    if (i % 2) state.segment<4>(3) *= -1;  // the same rotation
    const Eigen::VectorXd smooth = filter.filter(state, i * kFrame);
    EXPECT_LT(difference(f.scene, smooth, state).segment<3>(3).norm(), 0.04) << i;
  }
}

TEST(OneEuro, BeginsAnewWhereItIsTold) {
  const SmoothedHand f;
  OneEuroFilter filter(f.scene, f.settings);
  filter.filter(f.state({0, 0, 0.5}, {0, 0, 0}, 0), 0);
  filter.begin_anew();
  const Eigen::VectorXd other = f.state({0.1, 0, 0.6}, {1, 0, 0}, 0.5);
  EXPECT_EQ(filter.filter(other, kFrame), other);
  EXPECT_EQ(filter.filter(f.state({0, 0, 0}, {0, 0, 0}, 0), kFrame),
            f.state({0, 0, 0}, {0, 0, 0}, 0))
      << "no time has passed";
}

}  // namespace
}  // namespace hypotrack
