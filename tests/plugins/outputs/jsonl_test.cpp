#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "hypotrack/api/solution.hpp"
#include "output_run.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using nlohmann::json;
using ::testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class JsonlTest : public ::testing::Test {
 protected:
  std::vector<json> read() const {
    std::vector<json> out;
    for (const std::string& line : run_.lines("track.jsonl")) out.push_back(json::parse(line));
    return out;
  }

  const Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())},
                      {"box", std::make_shared<Model>(test::make_test_box())}}};
  test::OutputRun run_{scene_};
};

TEST_F(JsonlTest, EveryFrameIsALineWithParametersAndLandmarksByName) {
  const std::vector<Solution> solutions = test::random_solutions(scene_, 3);
  run_.play("type: jsonl", solutions);
  const std::vector<json> frames = read();
  ASSERT_THAT(frames, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    const json& hand = frames[i]["models"]["hand"];
    EXPECT_EQ(frames[i]["frame"], i);
    EXPECT_EQ(frames[i]["time"], solutions[i].time);
    EXPECT_EQ(hand["status"], "tracked");
    EXPECT_EQ(hand["probability"], 0.9);
    EXPECT_EQ(hand["parameters"]["position_z"], solutions[i].state[2]);
    EXPECT_THAT(hand["parameters"], SizeIs(27));
    EXPECT_THAT(hand["landmarks"], SizeIs(21));
    const json& box = frames[i]["models"]["box"];
    EXPECT_EQ(box["parameters"]["rotation_w"], solutions[i].state[30]);
    const std::string first = scene_.items()[1].model->data().landmarks[0].name;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(box["landmarks"][first][axis], solutions[i].landmarks(axis, 21));
  }
}

TEST_F(JsonlTest, StampsOfTheRecordingKeepAllDigits) {
  const std::vector<Solution> solutions = test::random_solutions(scene_, 2);
  run_.play("type: jsonl", solutions);
  EXPECT_FALSE(read().at(0).contains("stamp"));
  run_.stamp = -5;
  run_.play("type: jsonl", solutions);
  EXPECT_THAT(run_.lines("track.jsonl").at(0), ::testing::HasSubstr("\"stamp\":-0.000000005,"));
  run_.stamp = 1403636579763555584;
  run_.play("type: jsonl", solutions);
  EXPECT_THAT(run_.lines("track.jsonl").at(1),
              ::testing::HasSubstr("\"stamp\":1403636579.763555585,\"status\""));
  EXPECT_EQ(read().at(1)["time"], solutions[1].time);
  EXPECT_DOUBLE_EQ(read().at(1)["stamp"], 1403636579.763555585);
}

TEST_F(JsonlTest, UnknownNumbersAreNull) {
  Solution solution = test::random_solutions(scene_, 1).front();
  solution.cost = std::numeric_limits<double>::infinity();
  solution.probabilities[1] = kNan;
  test::set_status(solution, 0, Status::lost);
  run_.play("type: jsonl", {solution});
  const json frame = read().at(0);
  EXPECT_TRUE(frame["cost"].is_null());
  EXPECT_EQ(frame["status"], "lost");
  EXPECT_EQ(frame["models"]["hand"]["status"], "lost");
  EXPECT_EQ(frame["models"]["box"]["status"], "tracked");
  EXPECT_TRUE(frame["models"]["box"]["probability"].is_null());
}

TEST_F(JsonlTest, LinesAreThereBeforeTheRunEnds) {
  const auto output = run_.open("type: jsonl");
  output->begin(run_);
  output->frame({}, test::random_solutions(scene_, 1).front());
  EXPECT_THAT(read(), SizeIs(1));
}

TEST_F(JsonlTest, WritesSolutionsBeforeSmoothingWhereAsked) {
  const std::vector<Solution> solutions = test::random_solutions(scene_, 2);
  const auto output = run_.open("{type: jsonl, online: true}");
  output->begin(run_);
  output->online({}, solutions[0]);
  output->frame({}, solutions[1]);
  const std::vector<json> frames = read();
  ASSERT_THAT(frames, SizeIs(1));
  EXPECT_EQ(frames[0]["frame"], 0);
}

TEST_F(JsonlTest, ASolutionIsJsonWhateverBytesItsNamesHave) {
  const Scene odd{{{"b\xfcx\"\n", std::make_shared<Model>(test::make_test_box())}}};
  const std::string text = solution_json(odd, test::random_solutions(odd, 1).front());
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_TRUE(json::parse(text)["models"].contains("b\xef\xbf\xbdx\"\n"));
}

}  // namespace
}  // namespace hypotrack
