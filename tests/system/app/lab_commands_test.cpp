#include "app_test.hpp"
#include "cost/cuda/device.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The program's usage of the lab's commands: compare, bench, reliability, report.
class LabCommandsTest : public AppTest {
 protected:
  Outcome compare(const std::string& study, const std::vector<std::string>& more = {}) const {
    write_text(path("study.yaml"), study);
    std::vector<std::string> arguments{"compare", path("study.yaml").string(), "--out",
                                       path("out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(LabCommandsTest, MistakesOfUsageEndWithTwo) {
  const std::vector<std::vector<std::string>> mistakes = {
      {"compare", "a.yaml", "--out", ""}, {"reliability", "a", "--out", ""},
      {"report", "a", "--out", ""},       {"bench", "a.yaml", "--out", ""},
      {"bench", "--frames", "0"},         {"bench", "--rounds", "many"},
      {"bench", "--seconds", "0"},
  };
  for (const auto& arguments : mistakes) {
    const Outcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_NE(outcome.err, "") << testing::PrintToString(arguments);
  }
  EXPECT_THAT(run_program({"bench", "--seconds", "0"}).err,
              HasSubstr("--seconds: expected a number above 0, found '0'"));
  EXPECT_THAT(run_program({"report", "a", "--out", ""}).err,
              HasSubstr("--out: is empty, expected a name"));
}

TEST_F(LabCommandsTest, OptionsOfBenchMayStandBeforeTheScene) {
  const std::string file = scene(box_scene());
  EXPECT_THAT(run_program({"bench", "--set", "a=b", file}).err,
              HasSubstr("--set a=b: a: unknown key. Allowed: models, source"));
  EXPECT_THAT(run_program({"bench", "--backends", "cpu,none", file}).err,
              HasSubstr("--backends none: the table has no such case"));
}

TEST_F(LabCommandsTest, ARunThatGoesOnIsNotRead) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  std::filesystem::remove(path("out/summary.json"));  // the last file of a run
  for (const char* command : {"reliability", "report"}) {
    const Outcome outcome = run_program({command, path("out").string()});
    EXPECT_EQ(outcome.exit_code, 1) << command;
    EXPECT_THAT(outcome.err, HasSubstr("the run has not ended, or was killed")) << command;
  }
}

TEST_F(LabCommandsTest, ASceneIsNoStudy) {
  expect_refusal(run_program({"compare", scene(box_scene()), "--out", path("out").string()}),
                 {"scene.yaml: this is a scene, no study", "`hypotrack run`"});
}

TEST_F(LabCommandsTest, ALostDeviceIsARowOfAStudy) {
  scene(box_scene(), "box.yaml");
  const Outcome outcome =
      compare(R"(title: A lost device
scenes: {box: {file: box.yaml}}
grid:
  objective:
    good: {objective: {type: stereo_color}}
    bad: {objective: {type: failing, frames: 1}}
)",
              {"--plugin-path", (build_dir() / "tests/plugin_fixtures/app").string()});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_THAT(read_text(path("out/results.csv")),
              AllOf(HasSubstr("box,good,1,ok,,"), HasSubstr("box,bad,1,failed,"),
                    HasSubstr("the device is lost")));
}

/// A test on a machine without a GPU.
class LabWithoutDeviceTest : public LabCommandsTest {
 protected:
  void SetUp() override {
    const std::string why = cuda::why_no_device();
    if (why.empty()) GTEST_SKIP() << "needs a machine without a GPU";
    message_ = {"evaluate.backend: cuda: " + why, "Write `backend: cpu`"};
  }

  /// What is missing and what to write instead.
  std::vector<std::string> message_;
};

TEST_F(LabWithoutDeviceTest, AStudyThatNeedsOneRunsNothing) {
  scene(box_scene() + "evaluate: {backend: cuda}\n", "box.yaml");
  std::vector<std::string> pieces = message_;
  pieces.push_back("nothing was run");
  expect_refusal(compare("title: A GPU\nscenes: {box: {file: box.yaml}}\n"), pieces);
}

TEST_F(LabWithoutDeviceTest, AStudyThatChoosesGpusRunsNothing) {
  scene(box_scene(), "box.yaml");
  const Outcome outcome =
      compare("title: GPUs\nscenes: {box: {file: box.yaml}}\n", {"--gpus", "all"});
  expect_refusal(outcome, {"--gpus all: " + cuda::why_no_device()});
}

TEST_F(LabWithoutDeviceTest, ABenchmarkHasARowForIt) {
  const Outcome outcome =
      run_program({"bench", scene(box_scene()), "--backends", "cpu,cuda", "--frames", "3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(testing::ContainsRegex("cuda +- unavailable \\[1\\]"),
                                 HasSubstr("[1] " + message_[0]), HasSubstr(message_[1])));
}

}  // namespace
}  // namespace hypotrack::test
