#include "track/recover/held_models.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "hypotrack/plugin/model.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

class HeldTest : public testing::Test {
 protected:
  /// A hand half a metre away, and a box beside its wrist.
  HeldTest() : state_(scene_.rest_state()) {
    at(hand_, {0, 0, 0.5});
    at(box_, {0, 0.04, 0.5});
  }
  void at(std::size_t model, const Eigen::Vector3d& position) {
    state_.segment<3>(scene_.items()[model].offset) = position;
  }
  void turn(std::size_t model, double angle, const Eigen::Vector3d& axis) {
    Eigen::Isometry3d pose = pose_of(scene_.items()[model], state_);
    pose.rotate(Eigen::AngleAxisd(angle, axis));
    set_pose(scene_.items()[model], pose, state_);
  }

  const Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())},
                      {"box", std::make_shared<Model>(test::make_test_box())}}};
  static constexpr std::size_t hand_ = 0, box_ = 1;
  Eigen::VectorXd state_;
};

TEST_F(HeldTest, ARigidModelNearAHandIsHeldAndAHandNearItIsNot) {
  EXPECT_TRUE(held_by(scene_, hand_, state_)[box_]);
  EXPECT_FALSE(held_by(scene_, hand_, state_)[hand_]);
  EXPECT_FALSE(held_by(scene_, box_, state_)[hand_]);
}

TEST_F(HeldTest, WhatLiesElsewhereIsNot) {
  at(box_, {0.5, 0, 0.5});
  EXPECT_FALSE(held_by(scene_, hand_, state_)[box_]);
}

TEST_F(HeldTest, WhatMovesWithTheHandHasNotMovedInIt) {
  const Eigen::VectorXd before = state_;
  at(hand_, {0.1, 0, 0.6});
  turn(hand_, 1, Eigen::Vector3d::UnitX());
  const Eigen::VectorXd now = moved_with(scene_, box_, hand_, before, state_);
  Eigen::VectorXd both = state_;
  set_pose(scene_.items()[box_], pose_of(scene_.items()[box_], now), both);
  EXPECT_NEAR(moved_while_held(scene_, before, both, {true, true}), 0, 1e-9);
  EXPECT_GT(moved_while_held(scene_, before, state_, {true, true}), 0.05);
  EXPECT_EQ(moved_while_held(scene_, before, state_, {true, false}), 0);
}

TEST_F(HeldTest, HalfATurnOfABoxMovesItsCorners) {
  const Eigen::VectorXd before = state_;
  turn(box_, std::numbers::pi, Eigen::Vector3d::UnitZ());
  EXPECT_GT(moved_while_held(scene_, before, state_, {true, true}), 0.01);
}

}  // namespace
}  // namespace hypotrack
