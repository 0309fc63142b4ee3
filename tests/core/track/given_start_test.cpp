#include "track/loop/given_start.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "test_models.hpp"

namespace hypotrack {
namespace {

class GivenStartTest : public testing::Test {
 protected:
  Eigen::VectorXd moved_by(double metres) const {
    Eigen::VectorXd state = scene_.rest_state();
    state.x() += metres;
    return state;
  }

  Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())}}};
  GivenStart start_{scene_, scene_.rest_state(), true};
};

TEST_F(GivenStartTest, IsLeftByPosesTooFarForASearchFromTheRightPosture) {
  EXPECT_NEAR(start_.distance(0, moved_by(0.02)), 0.02, 1e-9);
  EXPECT_FALSE(start_.is_left(0, moved_by(0.01)));
  EXPECT_TRUE(start_.is_left(0, moved_by(0.02)));
}

TEST_F(GivenStartTest, ExpectsAModelUntilItIsContradicted) {
  start_.doubt(0, "a reason");
  EXPECT_TRUE(start_.expects(0) && start_.expects_any());
  start_.contradict(0, "a reason");
  EXPECT_FALSE(start_.expects(0) || start_.expects_any());
}

TEST_F(GivenStartTest, ExpectsNothingWhereNoneIsGiven) {
  EXPECT_FALSE(GivenStart(scene_, scene_.rest_state(), false).expects_any());
}

TEST_F(GivenStartTest, IsNotedOncePerModel) {
  start_.contradict(0, "a reason");
  start_.conclude(7, 0, {}, false);
  start_.doubt(0, "another");
  start_.conclude(8, 0, {}, false);
  const std::vector<std::string> notes = start_.take_notes();
  ASSERT_EQ(notes.size(), 1);
  EXPECT_EQ(notes[0],
            "frame 7: the start (init) may not be where 'hand' is: a reason; it is looked for in "
            "the pictures. Is the start of another frame or recording?");
  EXPECT_TRUE(start_.take_notes().empty());
}

TEST_F(GivenStartTest, IsNotedWhereAModelIsFoundFartherThanAStartByHandIsOff) {
  start_.doubt(0, "a reason");
  start_.conclude(7, 0, moved_by(0.03), true);
  EXPECT_TRUE(start_.take_notes().empty());
  start_.conclude(8, 0, moved_by(0.06), true);
  EXPECT_TRUE(start_.take_notes().empty()) << "the doubt was settled";
  start_.doubt(0, "a reason");
  start_.conclude(9, 0, moved_by(0.06), true);
  const std::vector<std::string> notes = start_.take_notes();
  ASSERT_EQ(notes.size(), 1);
  EXPECT_EQ(notes[0],
            "frame 9: the start (init) is not where 'hand' is: a reason; it was found 60 mm away "
            "(mean over the landmarks). Is the start of another frame or recording?");
}

TEST_F(GivenStartTest, CountsItsSearchesOfWhichThreeAreEarly) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(start_.is_early()) << i;
    EXPECT_EQ(start_.count_search(), i);
  }
  EXPECT_FALSE(start_.is_early());
}

TEST(GivenStartOdds, FallSoThatOnlySurePosesAreBelieved) {
  EXPECT_EQ(GivenStart::doubted(0), 0);
  EXPECT_EQ(GivenStart::doubted(1), 1);
  EXPECT_LT(GivenStart::doubted(0.95), 0.5);
  EXPECT_GT(GivenStart::doubted(0.995), 0.8);
}

}  // namespace
}  // namespace hypotrack
