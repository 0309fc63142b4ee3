#include "clicking/clicker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clicked_scene.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::clicking {
namespace {

using testing::HasSubstr;

class ClickerTest : public testing::Test {
 protected:
  test::ClickedScene world_;
  Clicker clicker_{world_.scene, world_.cameras, 8};
};

TEST_F(ClickerTest, AsksForTheWristFirstAndFitsAfterFourLandmarks) {
  EXPECT_EQ(clicker_.asked(), "wrist");
  EXPECT_EQ(clicker_.press('s'), Clicker::Answer::go_on) << "there is nothing to save";
  for (int i = 0; i < 4; ++i) {
    EXPECT_FALSE(clicker_.fit());
    world_.click(clicker_);
    clicker_.press('n');
  }
  ASSERT_TRUE(clicker_.fit());
  EXPECT_EQ(clicker_.clicks().size(), 4);
  EXPECT_EQ(clicker_.complete_models(), std::vector<bool>{true});
  for (const ClickResidual& r : clicker_.fit()->residuals) EXPECT_LT(r.distance, 2e-3);
  EXPECT_EQ(clicker_.drawing().state, clicker_.fit()->state);
  EXPECT_EQ(clicker_.press('s'), Clicker::Answer::save);
}

TEST_F(ClickerTest, AsksForTheModelsClearLandmarksBeforeTheOthersInTheirOrder) {
  std::vector<std::string> asked;
  for (int i = 0; i < 5; ++i) {
    asked.push_back(clicker_.asked());
    clicker_.press('n');
  }
  EXPECT_THAT(asked,
              testing::ElementsAre("wrist", "index_tip", "thumb_tip", "middle_tip", "ring_tip"));
}

TEST_F(ClickerTest, DrawsTheLineOnWhichTheOtherClickMustLie) {
  const Eigen::Vector2d left = world_.pixel("wrist", 0), right = world_.pixel("wrist", 1);
  EXPECT_EQ(clicker_.drawing().lines[1].cols(), 0);
  clicker_.click(0, left);
  const ClickDrawing drawing = clicker_.drawing();
  ASSERT_GT(drawing.lines[1].cols(), 2);
  EXPECT_EQ(drawing.lines[0].cols(), 0);
  for (const double y : drawing.lines[1].row(1)) EXPECT_NEAR(y, right.y(), 1e-6);
  EXPECT_THAT(drawing.text.front(), HasSubstr("right view"));
  ASSERT_EQ(drawing.marks.size(), 1);
  EXPECT_TRUE(drawing.marks[0].asked);
  EXPECT_EQ(drawing.marks[0].name, "wrist");
}

TEST_F(ClickerTest, TakesALaterClickInPlaceOfAnEarlierOneAndUndoesIt) {
  clicker_.click(0, {10, 20});
  clicker_.click(0, {30, 40});
  ASSERT_EQ(clicker_.drawing().marks.size(), 1);
  EXPECT_EQ(clicker_.drawing().marks[0].at, Eigen::Vector2d(30, 40));
  clicker_.press('u');
  EXPECT_EQ(clicker_.drawing().marks[0].at, Eigen::Vector2d(10, 20));
  clicker_.press('u');
  EXPECT_TRUE(clicker_.drawing().marks.empty());
  clicker_.press('u');
  EXPECT_TRUE(clicker_.drawing().marks.empty()) << "there is nothing left to undo";
}

TEST_F(ClickerTest, SkipsALandmarkAndUndoesThat) {
  clicker_.click(0, {10, 20});
  clicker_.press('x');
  EXPECT_NE(clicker_.asked(), "wrist");
  EXPECT_TRUE(clicker_.drawing().marks.empty());
  clicker_.press('u');
  EXPECT_EQ(clicker_.asked(), "wrist");
  EXPECT_EQ(clicker_.drawing().marks.size(), 1);
}

TEST_F(ClickerTest, StaysWithinTheLandmarks) {
  clicker_.press('p');
  EXPECT_EQ(clicker_.asked(), "wrist");
  for (int i = 0; i < 100; ++i) clicker_.press('n');
  const std::string last = clicker_.asked();
  clicker_.press('n');
  EXPECT_EQ(clicker_.asked(), last);
  clicker_.press('p');
  EXPECT_NE(clicker_.asked(), last);
}

TEST_F(ClickerTest, SaysWhichClicksDoNotMeetAndSavesNothing) {
  for (int i = 0; i < 4; ++i) {
    world_.click(clicker_);
    clicker_.press('n');
  }
  clicker_.press('p');
  const std::string name = clicker_.asked();
  clicker_.click(1, world_.pixel(name, 1) + Eigen::Vector2d(0, 30));
  EXPECT_FALSE(clicker_.fit());
  EXPECT_THAT(clicker_.drawing().text[1], HasSubstr("'" + name + "' (30.0 px)"));
  EXPECT_EQ(clicker_.drawing().state.size(), 0);
  EXPECT_EQ(clicker_.press('s'), Clicker::Answer::go_on);
  EXPECT_EQ(clicker_.press('q'), Clicker::Answer::quit);
}

TEST(ClickerOfTwoModels, FitsTheOneThatHasEnoughClicks) {
  const test::ClickedScene world;
  const Scene scene({{"box", std::make_shared<Model>(test::make_test_box())},
                     {"hand", std::make_shared<test::ClearHand>()}});
  Clicker clicker(scene, world.cameras, 8);
  EXPECT_TRUE(clicker.asked().starts_with("box."));
  clicker.click(0, {300, 200});
  clicker.click(1, {200, 200});
  while (clicker.asked() != "hand.wrist") clicker.press('n');
  for (int i = 0; i < 4; ++i) {
    const std::string name = clicker.asked().substr(std::string("hand.").size());
    for (const std::size_t view : {0, 1}) clicker.click(view, world.pixel(name, view));
    clicker.press('n');
  }
  ASSERT_TRUE(clicker.fit()) << clicker.drawing().text[1];
  EXPECT_EQ(clicker.complete_models(), (std::vector<bool>{false, true}));
  EXPECT_EQ(clicker.drawing().hidden, (std::vector<bool>{true, false}));
  ASSERT_EQ(clicker.clicks().size(), 4) << "one click does not place the box";
  EXPECT_EQ(clicker.clicks()[0].landmark, "hand.wrist");
}

TEST(ClickerOfOneView, IsRefused) {
  test::ClickedScene world;
  world.cameras.pop_back();
  EXPECT_THAT(test::message_of<DataError>([&] { Clicker(world.scene, world.cameras, 8); }),
              HasSubstr("two views, and the source has one"));
}

}  // namespace
}  // namespace hypotrack::clicking
