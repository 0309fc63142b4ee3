#include <csignal>

#include "compare_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

class CompareFailureTest : public CompareTest {
 protected:
  /// The study with a plugin in it that fails in the second frame.
  static std::string failing(const std::string& how, int frames = 1) {
    return replaced(study(), "  optimizer.particles: [4, 8]\n",
                    "  method:\n"
                    "    good: {optimizer: {type: pso, particles: 4, generations: 2}}\n"
                    "    bad: {optimizer: {type: failing, frames: " +
                        std::to_string(frames) + ", how: " + how + "}}\n");
  }

  Outcome compare_failing(const std::string& how, const std::vector<std::string>& more = {},
                          int frames = 1) const {
    std::vector<std::string> arguments{"--plugin-path",
                                       (build_dir() / "tests/plugin_fixtures/app").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return compare(failing(how, frames), "out", arguments);
  }

  /// A study that must be refused before anything is written.
  void expect_study_refused(const std::string& text, const std::vector<std::string>& pieces) const {
    const Outcome outcome = compare(text);
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    for (const std::string& piece : pieces) EXPECT_THAT(outcome.err, HasSubstr(piece));
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }
};

TEST_F(CompareFailureTest, AFailedRunIsARowAndNotTheEnd) {
  const Outcome outcome = compare_failing("exception");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("failed: box, method bad, seed 1:"));
  EXPECT_THAT(outcome.out, HasSubstr("4 of 4 runs are there, 2 failed"));
  const auto results = lines_of(table("results.csv"));
  ASSERT_THAT(results, SizeIs(5));
  EXPECT_THAT(results[1], testing::StartsWith("box,good,1,ok,,"));
  EXPECT_THAT(results[3],
              AllOf(testing::StartsWith("box,bad,1,failed,"), HasSubstr("the search is broken")));
  EXPECT_THAT(lines_of(table("cells.csv"))[2], testing::StartsWith("box,bad,2,2,"));
}

TEST_F(CompareFailureTest, ACrashIsARowToo) {
  const Outcome outcome = compare_failing("segfault");
  EXPECT_EQ(outcome.exit_code, 3);
  const auto results = lines_of(table("results.csv"));
  ASSERT_THAT(results, SizeIs(5));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  // Sanitizers turn the signal into an exit code.
  EXPECT_THAT(results[3], AllOf(HasSubstr("frame 0: "), HasSubstr("optimizer 'failing'"),
                                HasSubstr("ended by signal 11 (Segmentation fault)")));
#endif
}

TEST_F(CompareFailureTest, ARunThatEndsBeforeItReportedFailedWhateverItsExitCode) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the sanitizer gives a program that ends with running threads its own exit code";
#endif
  for (const auto& [how, message] :
       {std::pair{"exit", "ended the program by exit() before its work was done"},
        std::pair{"underscore_exit", "ended with exit code 0 before its results were complete"},
        std::pair{"interrupted_code", "ended with exit code 130"}}) {
    std::filesystem::remove_all(path("out"));
    const Outcome outcome = compare_failing(how);
    EXPECT_EQ(outcome.exit_code, 3) << how << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("4 of 4 runs are there, 2 failed")) << how;
    const auto results = lines_of(table("results.csv"));
    ASSERT_THAT(results, SizeIs(5)) << how;
    EXPECT_THAT(results[1], testing::StartsWith("box,good,1,ok,,"));
    EXPECT_THAT(results[3], AllOf(testing::StartsWith("box,bad,1,failed,"), HasSubstr(message)));
  }
}

TEST_F(CompareFailureTest, APluginThatEndsTheProgramIsFoundBeforeAnythingRuns) {
  const Outcome outcome = compare_failing("exit", {}, -1);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("optimizer 'failing': ended the program by exit()"),
                                 HasSubstr("while it was made"), HasSubstr("nothing was run")));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(CompareFailureTest, ARunThatNeverReturnsIsEndedAtTheTimeLimit) {
  const Outcome outcome = compare_failing("hang", {"--time-limit", "12"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  const auto results = lines_of(table("results.csv"));
  ASSERT_THAT(results, SizeIs(5));
  for (const int bad : {3, 4})
    EXPECT_THAT(results[static_cast<std::size_t>(bad)],
                AllOf(HasSubstr(",failed,"), HasSubstr("did not end within 12 s (--time-limit)")));
}

TEST_F(CompareFailureTest, ACheckThatNeverReturnsIsEndedAtTheTimeLimit) {
  const Outcome outcome = compare_failing("hang", {"--time-limit", "12"}, -1);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("method bad: did not end within 12 s (--time-limit)"),
                                 HasSubstr("nothing was run")));
}

TEST_F(CompareFailureTest, FailedRunsStayUnlessAskedForAgain) {
  ASSERT_EQ(compare_failing("exception").exit_code, 3);
  const Outcome again = compare_failing("exception");
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_THAT(again.err, HasSubstr("0 to make here"));
  const Outcome retried = compare_failing("exception", {"--retry-failed"});
  EXPECT_EQ(retried.exit_code, 3);
  EXPECT_THAT(retried.err, HasSubstr("2 to make here"));
  EXPECT_THAT(lines_of(table("results.csv")), SizeIs(5));
}

TEST_F(CompareFailureTest, ARunWithTruthThatLacksItsMetricsIsNoResult) {
  ASSERT_EQ(compare(study()).exit_code, 0);
  const auto run = path("out/runs") / run_names().front();
  std::filesystem::remove(run / "metrics.json");
  const Outcome damaged = compare(study());
  EXPECT_EQ(damaged.exit_code, 1) << damaged.out;
  EXPECT_THAT(damaged.err, AllOf(HasSubstr("metrics.json: no such file"),
                                 HasSubstr("remove the folder " + run.string())));
  std::filesystem::remove_all(run);
  const Outcome again = compare(study());
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("1 to make here"));
}

TEST_F(CompareFailureTest, ABadKeyIsFoundBeforeAnythingRuns) {
  expect_study_refused(replaced(study(), "optimizer.particles:", "optimizer.particle:"),
                       {"study.yaml:5:24: box, optimizer.particle 4: ", "did you mean 'particles'",
                        "2 of the study's 2 cells cannot be run", "nothing was run"});
}

TEST_F(CompareFailureTest, ABadValueIsNamedWithItsPlaceInTheStudy) {
  expect_study_refused(
      replaced(study(), "[4, 8]", "[4, 0]"),
      {"study.yaml:5:28: box, optimizer.particles 0: ", "expected an integer from 1"});
}

TEST_F(CompareFailureTest, AMissingPluginIsFoundBeforeAnythingRuns) {
  expect_study_refused(replaced(study(), "box.yaml}", "box.yaml, set: {objective.type: stereo}}"),
                       {"study.yaml:3:", "there is no objective 'stereo'"});
}

TEST_F(CompareFailureTest, ABrokenSceneFileIsNamed) {
  scene(replaced(box_scene(), "tile:", "tiel:"), "box.yaml");
  expect_study_refused(study(), {"study.yaml:3:3: box, ", "did you mean 'tile'", "box.yaml:"});
}

TEST_F(CompareFailureTest, AMissingDatasetIsFoundBeforeAnythingRuns) {
  ASSERT_EQ(run_program({"synth", path("box.yaml").string(), "--out", path("recording").string()})
                .exit_code,
            0);
  const std::string text = replaced(study(), "box.yaml", "recording/scene.yaml");
  for (const auto& name : names_in(path("recording")))
    if (name.ends_with(".png")) std::filesystem::remove(path("recording") / name);
  expect_study_refused(text, {"study.yaml:3:3: box, ", "left_"});
}

TEST_F(CompareFailureTest, ADatasetOfAnotherResolutionIsFoundBeforeAnythingRuns) {
  ASSERT_EQ(run_program({"synth", path("box.yaml").string(), "--out", path("recording").string()})
                .exit_code,
            0);
  ASSERT_EQ(run_program({"synth", path("box.yaml").string(), "--out", path("small").string(),
                         "--set", "source.cameras.width=80", "--set", "source.cameras.height=60"})
                .exit_code,
            0);
  std::filesystem::copy(path("small/calibration.yaml"), path("recording/calibration.yaml"),
                        std::filesystem::copy_options::overwrite_existing);
  expect_study_refused(replaced(study(), "box.yaml", "recording/scene.yaml"),
                       {"study.yaml:3:3: box, ", "160", "80"});
}

TEST_F(CompareFailureTest, ARecordingThatFailsIsNamedWithItsPlaceInTheStudy) {
  const std::string broken =
      "{file: box.yaml, set: {source: {type: failing, how: data_error, at: 20, "
      "source: \"@box.yaml#source\"}, source.source.frames: 60}}";
  const std::string text = replaced(study(), "{file: box.yaml}", broken) + "recordings: true\n";
  const Outcome outcome =
      compare(replaced(text, "frames: 3", "frames: 30"), "out",
              {"--plugin-path", (build_dir() / "tests/plugin_fixtures/app").string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("study.yaml:3:3: box, optimizer.particles 4: its source "
                                           "cannot be recorded: "),
                                 HasSubstr("the file is broken")));
}

TEST_F(CompareFailureTest, RecordingsMadeDuringTheChecksGoWithARefusedStudy) {
  if (std::thread::hardware_concurrency() < 2)
    GTEST_SKIP() << "needs a core beside that of the check";
  const std::string text =
      replaced(study(), "[4, 8]", "[4, 5, 6, 7, 8, 9, 10, -1]") + "recordings: true\n";
  Program program(start(text, "out", {"--jobs", "1", "--threads", "1"}));
  bool recorded = false;
  for (; program.running(); std::this_thread::sleep_for(std::chrono::milliseconds(2)))
    recorded = recorded || std::filesystem::exists(path("out/recordings"));
  const Outcome outcome = program.wait();
  EXPECT_TRUE(recorded);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("nothing was run"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(CompareFailureTest, AFolderOfSomethingElseIsRefused) {
  std::filesystem::create_directory(path("out"));
  write_text(path("out/thesis.tex"), "a year's work");
  const Outcome outcome = compare(study());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("is not empty and holds no study"));
  EXPECT_THAT(names_in(path("out")), ElementsAre("thesis.tex"));
}

TEST_F(CompareFailureTest, AShardIsAPartOfAWhole) {
  for (const char* shard : {"0/2", "3/2", "1", "1/", "a/b"}) {
    const Outcome outcome = compare(study(), "out", {"--shard", shard});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.err, HasSubstr("expected i/n with i from 1 to n"));
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }
}

TEST_F(CompareFailureTest, ADiskThatBecomesReadOnlyEndsTheStudyAndKeepsItsRuns) {
  Start on_disk = start(study(), "out");
  on_disk.environment = {"FAILING_DISK=" + path("out").string(), "READ_ONLY_AFTER=1200",
                         "LD_PRELOAD=" + (build_dir() / "tests/support/failing_disk.so").string()};
  const Outcome outcome = run_program(on_disk);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr(": Read-only file system"));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("unexpected error")));
  const Outcome again = compare(study(), "out", {"--retry-failed"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("4 of 4 runs are there, 0 failed"));
}

}  // namespace
}  // namespace hypotrack::test
