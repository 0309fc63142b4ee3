#include "output/metrics/motion_speeds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "hypotrack/plugin/params.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

constexpr int kBox = 27;

/// The hand rests and moves on by 3 mm along x per frame; in frame 2 it moves by 5 mm, turns by 4
/// degrees, and joint number 8 turns by 6. The box turns by 10 degrees in frame 3.
std::vector<StateRow> some_states(const Scene& scene) {
  std::vector<StateRow> rows(4, StateRow{0, 0, scene.rest_state()});
  const double x[] = {0, 0.003, 0.008, 0.011};
  for (int i = 0; i < 4; ++i) {
    rows[static_cast<std::size_t>(i)].frame = i;
    rows[static_cast<std::size_t>(i)].state[0] = x[i];
  }
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(4 * kDegree, Eigen::Vector3d::UnitY()));
  for (std::size_t i = 2; i < 4; ++i) {
    rows[i].state[7 + 8] += 6 * kDegree;
    rows[i].state.segment<4>(3) << turn.w(), turn.x(), turn.y(), turn.z();
  }
  rows[3].state.segment<4>(3) *= -1;  // the same rotation
  const Eigen::Quaterniond box(Eigen::AngleAxisd(10 * kDegree, Eigen::Vector3d::UnitX()));
  rows[3].state.segment<4>(kBox + 3) << box.w(), box.x(), box.y(), box.z();
  return rows;
}

TEST(MotionSpeeds, FindsThePeaksAndMeansOfEveryModel) {
  const Scene scene = test::make_hand_and_box();
  const auto speeds = motion_speeds(scene, some_states(scene));
  ASSERT_EQ(speeds.size(), 2U);
  const ModelSpeeds& hand = speeds[0];
  EXPECT_EQ(hand.model, "hand");
  EXPECT_NEAR(hand.translation.peak, 0.005, 1e-12);
  EXPECT_NEAR(hand.translation.mean, 0.011 / 3, 1e-12);
  EXPECT_EQ(hand.translation.frame, 2);
  EXPECT_NEAR(hand.rotation.peak, 4 * kDegree, 1e-7) << "a quaternion's sign turns nothing";
  EXPECT_EQ(hand.rotation.frame, 2);
  EXPECT_NEAR(hand.joints.peak, 6 * kDegree, 1e-12);
  EXPECT_NEAR(hand.joints.mean, 2 * kDegree, 1e-12);
  EXPECT_EQ(hand.fastest_joint, scene.items()[0].model->data().parameters[7 + 8].name);
  EXPECT_NEAR(speeds[1].rotation.peak, 10 * kDegree, 1e-7);
  EXPECT_EQ(speeds[1].rotation.frame, 3);
  EXPECT_EQ(speeds[1].translation.peak, 0);
  EXPECT_EQ(speeds[1].fastest_joint, "");
}

TEST(MotionSpeeds, TellsJointsThatSlideFromThoseThatTurn) {
  const Scene scene({{"cabinet", std::make_shared<Model>(test::make_test_cabinet())}});
  std::vector<StateRow> rows(2, StateRow{0, 0, scene.rest_state()});
  rows[1].frame = 1;
  rows[1].state[7] += 0.03;
  rows[1].state[9] += 12 * kDegree;
  const auto speeds = motion_speeds(scene, rows);
  EXPECT_EQ(speeds[0].fastest_slide, "drawer");
  EXPECT_NEAR(speeds[0].slides.peak, 0.03, 1e-12);
  EXPECT_EQ(speeds[0].fastest_joint, "knob");
  EXPECT_NEAR(speeds[0].joints.peak, 12 * kDegree, 1e-12);
  EXPECT_THAT(
      motion_text(speeds),
      testing::HasSubstr("joints 12.0 deg (knob, frame 1), joints 30.0 mm (drawer, frame 1)"));
  const auto json = nlohmann::json::parse(motion_json(speeds));
  EXPECT_EQ(json["models"]["cabinet"]["joint_mm_per_frame"]["joint"], "drawer");
}

TEST(MotionSpeeds, DoesNotCountOverMissingFrames) {
  const Scene scene = test::make_hand_and_box();
  auto states = some_states(scene);
  states.erase(states.begin() + 2);
  const auto speeds = motion_speeds(scene, states);
  EXPECT_NEAR(speeds[0].translation.peak, 0.003, 1e-12);
  EXPECT_NEAR(speeds[0].translation.mean, 0.003, 1e-12);
  EXPECT_EQ(speeds[0].rotation.peak, 0);
  EXPECT_EQ(motion_speeds(scene, std::span(states).first(1))[0].translation.mean, 0);
}

TEST(MotionSpeeds, DoesNotCountOverGapsInTime) {
  const Scene scene = test::make_hand_and_box();
  auto states = some_states(scene);
  for (std::size_t i = 0; i < states.size(); ++i)
    states[i].time = static_cast<double>(i + (i >= 2 ? 12 : 0)) / 30;
  const auto speeds = motion_speeds(scene, states);
  EXPECT_NEAR(speeds[0].translation.peak, 0.003, 1e-12) << "5 mm over the gap";
  EXPECT_EQ(speeds[0].rotation.peak, 0);
}

TEST(MotionSpeeds, SaysThemInMillimetresAndDegrees) {
  const Scene scene = test::make_hand_and_box();
  const auto speeds = motion_speeds(scene, some_states(scene));
  const auto json = nlohmann::json::parse(motion_json(speeds))["models"];
  EXPECT_NEAR(json["hand"]["translation_mm_per_frame"]["peak"], 5, 1e-9);
  EXPECT_EQ(json["hand"]["joint_deg_per_frame"]["joint"], speeds[0].fastest_joint);
  EXPECT_NEAR(json["box"]["rotation_deg_per_frame"]["peak"], 10, 1e-5);
  EXPECT_FALSE(json["box"].contains("joint_deg_per_frame"));
  EXPECT_THAT(motion_text(speeds),
              testing::AllOf(testing::HasSubstr("hand: 5.0 mm (frame 2), 4.00 deg (frame 2), "
                                                "joints 6.0 deg (" +
                                                speeds[0].fastest_joint),
                             testing::HasSubstr("box: 0.0 mm (frame 0), 10.00 deg (frame 3) per")));
}

}  // namespace
}  // namespace hypotrack
