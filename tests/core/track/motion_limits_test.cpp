#include "track/motion_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "test_models.hpp"
#include "track/search/search_space.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

class MotionLimitsTest : public testing::Test {
 protected:
  Eigen::VectorXd moved_by(Eigen::Index i, double by) const {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(scene_.dimension() - 1);
    step[i] = by;
    return moved(scene_, scene_.rest_state(), step);
  }

  Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())}}};
  Reach reach_ = reach_within(MotionLimits{}, 1.0 / 30);
};

TEST_F(MotionLimitsTest, GrowWithTime) {
  const Reach later = reach_within(MotionLimits{}, 2.0 / 30);
  EXPECT_NEAR(later.position, 2 * reach_.position, 1e-12);
  EXPECT_NEAR(later.rotation, 2 * reach_.rotation, 1e-12);
  EXPECT_NEAR(later.angle, 2 * reach_.angle, 1e-12);
}

TEST_F(MotionLimitsTest, TakeFramesOfOneTimeForAThirtiethOfASecondApart) {
  for (const double seconds : {0.0, -1.0, std::nan("")})
    EXPECT_EQ(reach_within(MotionLimits{}, seconds).position, reach_.position);
}

TEST_F(MotionLimitsTest, RefuseAHandThatLeapsOrSpins) {
  const Eigen::VectorXd here = scene_.rest_state();
  EXPECT_TRUE(is_within(scene_, reach_, here, here));
  EXPECT_TRUE(is_within(scene_, reach_, here, moved_by(0, 0.05)));
  EXPECT_FALSE(is_within(scene_, reach_, here, moved_by(0, 0.35)));
  EXPECT_TRUE(is_within(scene_, reach_, here, moved_by(4, 0.5)));
  EXPECT_FALSE(is_within(scene_, reach_, here, moved_by(4, 2.5)));
}

TEST_F(MotionLimitsTest, BoundWhatASearchMayLookAt) {
  SearchSettings settings;
  settings.rotation_as = RotationCoordinates::tangent;
  const SearchSpace space(scene_, settings);
  const SearchRegion region = space.region(scene_.rest_state(), reach_);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(region.upper[i] - region.start[i], reach_.position, 1e-12);
    EXPECT_NEAR(region.upper[3 + i], reach_.rotation, 1e-12);
  }
  EXPECT_TRUE(std::isinf(space.region(scene_.rest_state()).upper[0]));
}

}  // namespace
}  // namespace hypotrack
