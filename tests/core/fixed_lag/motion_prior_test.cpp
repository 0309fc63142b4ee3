#include "track/smooth/motion_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "test_models.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

struct MovingBox {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  MotionPrior motion{scene, {.position_change = 0.5, .rotation_change = 2}};

  /// The box at `x`, turned by `turn` about z.
  TimedState at(double time, double x, double turn = 0) const {
    Eigen::VectorXd off = Eigen::VectorXd::Zero(6);
    off[0] = x;
    off[5] = turn;
    return {time, moved(scene, scene.rest_state(), off)};
  }
};

TEST(MotionPrior, ChargesNothingForAConstantSpeedWhateverTheTimesBetween) {
  const MovingBox f;
  EXPECT_NEAR(f.motion.cost(f.at(0, 0, 0), f.at(0.1, 0.1, 0.3), f.at(0.4, 0.4, 1.2)), 0, 1e-18);
}

TEST(MotionPrior, ChargesOneForTheSettingsChangeOfSpeedInASecond) {
  const MovingBox f;
  EXPECT_NEAR(f.motion.cost(f.at(0, 0), f.at(1, 0), f.at(2, 0.5)), 1, 1e-9);
  EXPECT_NEAR(f.motion.cost(f.at(0, 0), f.at(1, 0), f.at(2, 0, 2)), 1, 1e-9);
}

TEST(MotionPrior, FactorsAreHowItsResidualsGrow) {
  const MovingBox f;
  const std::vector<TimedState> states{f.at(0, 0.1), f.at(0.1, 0.3), f.at(0.3, 0.2)};
  const MotionPrior::Change before = f.motion.change(states[0], states[1], states[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<TimedState> off = states;
    off[k].state[0] += 0.01;
    EXPECT_NEAR(f.motion.change(off[0], off[1], off[2]).residual[0] - before.residual[0],
                0.01 * before.factor[k], 1e-9)
        << k;
  }
}

TEST(MotionPrior, TakesTimesThatDoNotGrow) {
  const MovingBox f;
  EXPECT_TRUE(std::isfinite(f.motion.cost(f.at(1, 0), f.at(1, 0.1), f.at(0.5, 0))));
}

}  // namespace
}  // namespace hypotrack
