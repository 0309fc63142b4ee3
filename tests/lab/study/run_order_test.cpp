#include "lab/study/run_order.hpp"

#include <gtest/gtest.h>

#include <array>

#include "study_test.hpp"

namespace hypotrack::test {
namespace {

/// Three cells, so that runs 0 to 2 are of the first seed and 3 to 5 of the second.
class RunOrderTest : public StudyTest {
 protected:
  study::Plan plan_ = plan(
      "title: t\nscenes: {box: {file: box.yaml}}\ngrid: {optimizer.particles: [4, 8, 16]}\n"
      "seeds: 2");
  study::RunOrder order_{plan_};
  /// Runs 0 and 1 are of the box, 2 and 3 of the hand.
  study::Plan two_scenes_ = plan(
      "title: t\nscenes: {box: {file: box.yaml}, hand: {file: hand.yaml}}\n"
      "grid: {optimizer.particles: [4, 8]}");
};

TEST_F(RunOrderTest, IsThatOfThePlanWhileNoTimeIsKnown) {
  EXPECT_EQ(order_.next(std::array<std::size_t, 3>{1, 2, 3}), 1U);
}

TEST_F(RunOrderTest, BeginsWithTheCellThatTookLongest) {
  order_.took(0, 1.0);
  order_.took(1, 3.0);
  order_.took(2, 2.0);
  EXPECT_EQ(order_.next(std::array<std::size_t, 3>{3, 4, 5}), 4U);
  EXPECT_EQ(order_.next(std::array<std::size_t, 2>{3, 5}), 5U);
}

TEST_F(RunOrderTest, BeginsWithCellsWithoutATime) {
  order_.took(0, 1.0);
  order_.took(2, 2.0);
  EXPECT_EQ(order_.next(std::array<std::size_t, 3>{3, 4, 5}), 4U);
}

TEST_F(RunOrderTest, RunsThatBeginTogetherReadDifferentPictures) {
  study::RunOrder order(two_scenes_);
  EXPECT_EQ(order.next(std::array<std::size_t, 4>{0, 1, 2, 3}, 0), 0U);
  order.begins(0, 0);
  EXPECT_EQ(order.next(std::array<std::size_t, 3>{1, 2, 3}, 0), 2U);
  order.begins(2, 0);
  EXPECT_EQ(order.next(std::array<std::size_t, 2>{1, 3}, 0), 1U);
  order.took(1, 1.0);
  order.took(3, 2.0);
  EXPECT_EQ(order.next(std::array<std::size_t, 2>{1, 3}, 0), 3U);  // it takes longer
}

TEST_F(RunOrderTest, AGpuKeepsToItsPicturesWhileItCan) {
  study::RunOrder order(two_scenes_);
  EXPECT_EQ(order.next(std::array<std::size_t, 4>{0, 1, 2, 3}, 0), 0U);
  order.begins(0, 0);
  order.took(1, 9.0);
  EXPECT_EQ(order.next(std::array<std::size_t, 3>{1, 2, 3}, 1), 2U);
  order.begins(2, 1);
  order.took(3, 1.0);
  EXPECT_EQ(order.next(std::array<std::size_t, 2>{1, 3}, 1), 3U);  // though 1 takes longer
  EXPECT_EQ(order.next(std::array<std::size_t, 1>{1}, 1), 1U);     // helps the other one
}

TEST_F(RunOrderTest, FinishesASeedBeforeTheNext) {
  order_.took(0, 1.0);
  order_.took(1, 3.0);
  EXPECT_EQ(order_.next(std::array<std::size_t, 3>{0, 3, 4}), 0U);
}

}  // namespace
}  // namespace hypotrack::test
