#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "expect_error.hpp"
#include "hand_points.hpp"
#include "output_run.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class KeypointsTest : public ::testing::Test {
 protected:
  std::vector<nlohmann::json> read() const {
    std::vector<nlohmann::json> out;
    for (const std::string& line : run_.lines("keypoints.jsonl"))
      out.push_back(nlohmann::json::parse(line));
    return out;
  }
  /// Returns the landmark of a model that the detector names so.
  Eigen::Vector3d landmark(const Solution& solution, const std::string& model,
                           std::string_view name) const {
    const auto& names = scene_->landmark_names();
    const auto at = std::ranges::find(names, model + "." + std::string(name)) - names.begin();
    return solution.landmarks.col(at);
  }

  const std::unique_ptr<Scene> scene_ =
      test::make_scene({{"box", "{type: rigid_box, size_mm: [60, 90, 40]}"},
                        {"right", "type: hand"},
                        {"left", "type: mirrored_hand"}});
  test::OutputRun run_{*scene_};
};

/// Expects a point's coordinates and a confidence at an index of the list.
void expect_point(const nlohmann::json& list, std::size_t index, const Eigen::VectorXd& point,
                  double confidence) {
  const auto size = static_cast<std::size_t>(point.size()) + 1;
  ASSERT_THAT(list, SizeIs(size * kHandPointNames.size()));
  for (Eigen::Index i = 0; i < point.size(); ++i)
    EXPECT_NEAR(list[size * index + static_cast<std::size_t>(i)], point[i], 1e-9);
  EXPECT_EQ(list[size * index + size - 1], confidence);
}

TEST_F(KeypointsTest, HandsHaveTheirPointsInTheWorldInTheCameraAndInEveryView) {
  const std::vector<Solution> solutions = test::random_solutions(*scene_, 2);
  run_.play("type: keypoints", solutions);
  const auto frames = read();
  ASSERT_THAT(frames, SizeIs(2));
  EXPECT_EQ(frames[1]["frame"], 1);
  EXPECT_EQ(frames[1]["time"], 1 / 30.0);
  ASSERT_THAT(frames[1]["people"], SizeIs(2)) << "a box is nobody";
  for (std::size_t h = 0; h < 2; ++h) {
    const nlohmann::json& person = frames[1]["people"][h];
    const std::string name = h == 0 ? "right" : "left";
    EXPECT_EQ(person["name"], name);
    const std::string prefix = "hand_" + name + "_keypoints_";
    for (std::size_t i = 0; i < kHandPointNames.size(); ++i) {
      const Eigen::Vector3d point = landmark(solutions[1], name, kHandPointNames[i]);
      expect_point(person[prefix + "3d"], i, point, 0.9);
      expect_point(person[prefix + "3d_camera"], i, run_.cameras()[0].camera_from_world * point,
                   0.9);
      expect_point(person[prefix + "2d"], i, project(run_.cameras()[0], point), 0.9);
      for (std::size_t view = 0; view < 2; ++view)
        expect_point(person[prefix + "2d_views"][view], i, project(run_.cameras()[view], point),
                     0.9);
    }
    const std::string other = h == 0 ? "hand_left_keypoints_" : "hand_right_keypoints_";
    EXPECT_THAT(person[other + "2d"], SizeIs(0));
    EXPECT_THAT(person[other + "3d"], SizeIs(0));
  }
}

TEST_F(KeypointsTest, FramesHaveTheStampOfTheirPicturesToTheNanosecond) {
  run_.play("type: keypoints", test::random_solutions(*scene_, 1));
  EXPECT_FALSE(read().at(0).contains("stamp"));
  run_.stamp = 1403636579763555584;
  run_.play("type: keypoints", test::random_solutions(*scene_, 2));
  EXPECT_THAT(run_.lines("keypoints.jsonl").at(1),
              HasSubstr(",\"stamp\":1403636579.763555585,\"people\":["));
  EXPECT_EQ(read().at(1)["people"].size(), 2);
}

TEST_F(KeypointsTest, HandsThatAreNotSeenAreLeftOut) {
  std::vector<Solution> solutions = test::random_solutions(*scene_, 2);
  test::set_status(solutions[0], 1, Status::lost);
  for (const std::size_t m : {1U, 2U}) test::set_status(solutions[1], m, Status::absent);
  run_.play("type: keypoints", solutions);
  const auto frames = read();
  ASSERT_THAT(frames[0]["people"], SizeIs(1));
  EXPECT_EQ(frames[0]["people"][0]["name"], "left");
  EXPECT_EQ(frames[1]["people"], nlohmann::json::array());
}

TEST_F(KeypointsTest, ConfidenceFollowsTheStatusWhereNoProbabilityIsKnown) {
  Solution solution = test::random_solutions(*scene_, 1).front();
  solution.probabilities.assign(3, std::numeric_limits<double>::quiet_NaN());
  test::set_status(solution, 2, Status::uncertain);
  run_.play("type: keypoints", {solution});
  const nlohmann::json people = read().at(0)["people"];
  EXPECT_EQ(people[0]["hand_right_keypoints_2d"][2], 1.0);
  EXPECT_EQ(people[1]["hand_left_keypoints_2d"][2], 0.5);
  EXPECT_EQ(people[1]["status"], "uncertain");
}

TEST_F(KeypointsTest, PointsBehindACameraAreZero) {
  Solution solution = test::random_solutions(*scene_, 1).front();
  solution.state[scene_->items()[1].offset + 2] = -0.5;
  run_.play("type: keypoints", {solution});
  const nlohmann::json person = read().at(0)["people"][0];
  EXPECT_EQ(person["hand_right_keypoints_2d"], nlohmann::json(std::vector<double>(63, 0.0)));
  EXPECT_EQ(person["hand_right_keypoints_3d"][3], 0.9);
}

TEST_F(KeypointsTest, LinesAreThereBeforeTheRunEnds) {
  run_.play_killed("type: keypoints", test::random_solutions(*scene_, 2));
  EXPECT_THAT(read(), SizeIs(2));
}

TEST(Keypoints, ASceneWithoutAHandIsRefused) {
  const auto scene = test::make_scene({{"box", "{type: rigid_box, size_mm: [60, 90, 40]}"}});
  const test::OutputRun run(*scene);
  EXPECT_THAT(message_of<ConfigError>([&] { run.open("type: keypoints"); }),
              AllOf(HasSubstr("scene.yaml:1:1"), HasSubstr("no model of the scene is a hand"),
                    HasSubstr("leave keypoints out")));
}

}  // namespace
}  // namespace hypotrack
