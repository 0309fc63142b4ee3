#include "track/recover/pose_search.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "test_models.hpp"

namespace hypotrack {
namespace {

class DistinctTest : public testing::Test {
 protected:
  /// A box moved by some metres, of some cost.
  Refined at(double x, double cost) const {
    Eigen::VectorXd state = scene_.rest_state();
    state[0] = x;
    return {state, cost};
  }
  const Scene scene_{{{"box", std::make_shared<Model>(test::make_test_box())}}};
};

TEST_F(DistinctTest, OfPosesThatAreAlikeTheCheapestIsLeft) {
  std::vector<Refined> poses{at(0.101, 3), at(0, 2), at(0.1, 1), at(0.002, 4), at(0.2, 5)};
  leave_distinct(scene_, 0.01, 10, poses);
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0].state[0], 0.1);
  EXPECT_EQ(poses[1].state[0], 0);
  EXPECT_EQ(poses[2].state[0], 0.2);
}

TEST_F(DistinctTest, NoMoreAreLeftThanWanted) {
  std::vector<Refined> poses{at(0.2, 3), at(0.1, 2), at(0, 1)};
  leave_distinct(scene_, 0.01, 2, poses);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].cost, 2);
}

}  // namespace
}  // namespace hypotrack
