#include <csignal>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Plugins that fail while a frame is searched.
class PluginErrorsTest : public AppTest {
 protected:
  Outcome run_with(const std::string& text) const {
    return run(text, {"--plugin-path", (build_dir() / "tests/plugin_fixtures/app").string()});
  }
  /// Runs a scene whose optimizer works for one search.
  Outcome run_optimizer(const std::string& how, int frames = 1) const {
    return run_with(
        replaced(box_scene(), "{type: pso, particles: 8, generations: 4}",
                 "{type: failing, frames: " + std::to_string(frames) + ", how: " + how + "}"));
  }
  /// Runs a scene whose objective works for one frame.
  Outcome run_objective(const std::string& how, const std::string& optimizer = "pso") const {
    return run_with(replaced(replaced(box_scene(), "{type: pso, particles: 8, generations: 4}",
                                      "{type: " + optimizer + "}"),
                             "{type: stereo_color}",
                             "{type: failing, frames: 1, how: " + how + "}"));
  }
  /// Runs a scene whose model poses itself, and fails where a search poses it beside its path.
  Outcome run_model(const std::string& how) const {
    return run_with(replaced(box_scene(), "type: rigid_box, size_mm: [90, 60, 40]",
                             "type: failing, how: " + how));
  }
  /// Runs a scene whose source wraps that of the scene and fails at frame 3.
  Outcome run_source(const std::string& how) const {
    std::string text = box_scene();
    for (const std::string line :
         {"  cameras:", "  keyframes:", "    - {frame: 0", "    - {frame: 4"})
      text = replaced(text, line, "  " + line);
    return run_with(
        replaced(text, "  type: synthetic",
                 "  type: failing\n  how: " + how + "\n  source:\n    type: synthetic"));
  }
  /// Runs a scene whose judge fails after a few poses.
  Outcome run_judge(const std::string& how) const {
    return run_with(box_scene() + "judge: {type: failing, how: " + how + "}\n");
  }
  /// Runs a scene with an output that fails at frame 3.
  Outcome run_output(const std::string& how) const {
    return run_with(replaced(box_scene(), "output: {overlay: false}",
                             "output: {overlay: false, also: {type: failing, how: " + how + "}}"));
  }
  /// Expects one message with the place in the scene, the plugin and its library, and the frame.
  void expect_named(const Outcome& outcome, const std::string& who, const std::string& library,
                    const std::string& what) const {
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_THAT(outcome.err,
                testing::ContainsRegex("hypotrack: frame [0-4]: [^ ]*scene.yaml:[0-9]+:[0-9]+: " +
                                       who + " \\(/.*" + library + "\\): .*"));
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(what), Not(HasSubstr("unexpected error"))));
  }
  void expect_optimizer_named(const std::string& how, const std::string& what) const {
    expect_named(run_optimizer(how), "optimizer 'failing'", "libhypotrack_optimizer_failing.so",
                 what);
  }
};

TEST_F(PluginErrorsTest, AnExceptionOfAnOptimizerNamesItAndTheFrame) {
  expect_optimizer_named("exception", "threw std::runtime_error: the search is broken");
  expect_optimizer_named("int", "threw int, which is no std::exception");
  expect_optimizer_named("no_memory", "ran out of memory");
}

TEST_F(PluginErrorsTest, AnExceptionOfAnObjectiveNamesItAndNotTheOptimizer) {
  for (const auto& [how, what] :
       {std::pair{"exception", "threw std::runtime_error: the cost is broken"},
        std::pair{"int", "threw int, which is no std::exception"},
        std::pair{"device", ": the device is lost"}}) {
    const Outcome outcome = run_objective(how);
    expect_named(outcome, "objective 'failing'", "libhypotrack_objective_failing.so", what);
    EXPECT_THAT(outcome.err, Not(HasSubstr("optimizer")));
  }
}

TEST_F(PluginErrorsTest, CostsThatAreNeitherNumbersNorInfeasibleAreRefused) {
  for (const auto& [how, what] :
       {std::pair{"nan_cost", "the cost of a hypothesis is nan, expected a number or +infinity"},
        std::pair{"minus_infinity", "the cost of a hypothesis is -inf, expected"}})
    expect_named(run_objective(how), "objective 'failing'", "libhypotrack_objective_failing.so",
                 what);
}

TEST_F(PluginErrorsTest, ResidualsThatBreakTheContractAreRefused) {
  expect_named(run_objective("nan_residual", "levenberg_marquardt"), "objective 'failing'",
               "libhypotrack_objective_failing.so",
               "its residuals have nan in place 0 of 1, expected finite numbers");
  expect_named(run_objective("negative_count", "levenberg_marquardt"), "objective 'failing'",
               "libhypotrack_objective_failing.so", "has -7 residuals, expected 0 to");
}

TEST_F(PluginErrorsTest, JacobiansThatBreakTheContractAreRefused) {
  expect_named(run_objective("nan_jacobian", "levenberg_marquardt"), "objective 'failing'",
               "libhypotrack_objective_failing.so",
               "its Jacobian has nan for residual 0 of 1 and number 2 of 7 of the state, expected "
               "finite numbers");
  expect_named(run_objective("narrow_jacobian", "levenberg_marquardt"), "objective 'failing'",
               "libhypotrack_objective_failing.so",
               "its Jacobian is 1 x 6, expected 1 x 7 (residuals x numbers of the state)");
}

TEST_F(PluginErrorsTest, AnAnswerThatBreaksTheContractIsRefused) {
  expect_optimizer_named("short_point", "its answer has 3 numbers, expected ");
  expect_optimizer_named("outside", "number 0 of its answer is inf, expected ");
  expect_optimizer_named("too_cheap", "but the lowest of the 1 points that it evaluated has");
  expect_optimizer_named("minus_infinity", "its answer has cost -inf");
  expect_optimizer_named("negative_count", "says that it made -5 evaluations");
  expect_optimizer_named("over_budget", "made 97 evaluations, its budget is 2");
}

TEST_F(PluginErrorsTest, AMeshThatIsNoneNamesItsPlugin) {
  const Outcome outcome = run_model("nan_mesh");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              testing::ContainsRegex("hypotrack: .*scene.yaml:1:10: model 'failing': vertex 0 "));
}

TEST_F(PluginErrorsTest, AModelWithoutLandmarksNamesItsPlugin) {
  expect_refusal(run_model("no_landmarks"),
                 {"scene.yaml:1:10: model 'failing' (/", "_failing.so): has no landmarks"});
}

TEST_F(PluginErrorsTest, AModelThatFailsToPoseItselfIsNamedAndNotTheOptimizer) {
  for (const auto& [how, what] :
       {std::pair{"exception", "threw std::runtime_error: the pose is broken"},
        std::pair{"int", "threw int, which is no std::exception"},
        std::pair{"few_vertices", "its pose has 2 vertices, expected 3"},
        std::pair{"many_vertices", "its pose has 1000 vertices, expected 3"},
        std::pair{"few_landmarks", "its pose has 0 landmarks, expected 3"},
        std::pair{"nan_vertex", "nan m in place 1 of its vertices, expected finite numbers"},
        std::pair{"infinite_vertex", "inf m in place 1 of its vertices, expected finite numbers"},
        std::pair{"far_vertex", "e+30 m in place 1 of its vertices, expected finite numbers"},
        std::pair{"nan_landmark", "m in place 0 of its landmarks, expected finite numbers"}}) {
    const Outcome outcome = run_model(how);
    expect_named(outcome, "model 'failing'", "libhypotrack_model_failing.so", what);
    EXPECT_THAT(outcome.err, Not(HasSubstr("optimizer")));
  }
}

TEST_F(PluginErrorsTest, AnExceptionOfASourceNamesItAndTheFrameBefore) {
  for (const auto& [how, what] : {std::pair{"exception", "threw std::runtime_error: no picture"},
                                  std::pair{"data_error", "the file is broken"}}) {
    const Outcome outcome = run_source(how);
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_THAT(outcome.err,
                testing::ContainsRegex("hypotrack: after frame 2: /[^ ]*scene.yaml:3:3: source "
                                       "'failing' \\(/.*_failing.so\\): " +
                                       std::string(what)));
  }
}

TEST_F(PluginErrorsTest, PicturesThatBreakTheContractNameTheSourceAndTheFrame) {
  for (const auto& [how, what] :
       {std::pair{"grey",
                  "frame 3, view 1: the image is of OpenCV type CV_8UC1; expected 8-bit BGR"},
        std::pair{"small", "frame 3, view 1: the image is 10x10 pixels, its camera 160x120"},
        std::pair{"one_view", "frame 3 has 1 views; expected 2, one per camera"},
        std::pair{"three_views", "frame 3 has 3 views; expected 2, one per camera"}}) {
    const Outcome outcome = run_source(how);
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, testing::ContainsRegex("hypotrack: /[^ ]*scene.yaml:3:3: source "
                                                    "'failing': " +
                                                    std::string(what)));
  }
}

TEST_F(PluginErrorsTest, ASourceThatEndsBeforeItsAnnouncedEndIsSaidOnce) {
  const Outcome outcome = run_source("early_end");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::ContainsRegex("/[^ ]*scene.yaml:3:3: source 'failing': ends "
                                                  "after 3 frames, it announced 40"));
}

TEST_F(PluginErrorsTest, AnExceptionOrNanOfAJudgeNamesItAndTheFrame) {
  for (const auto& [how, what] :
       {std::pair{"exception", "threw std::runtime_error: the judge is broken"},
        std::pair{"int", "threw int, which is no std::exception"},
        std::pair{"nan", "the log odds of a pose are NaN, expected a number or an infinity"}})
    expect_named(run_judge(how), "judge 'failing'", "libhypotrack_judge_failing.so", what);
}

TEST_F(PluginErrorsTest, AnExceptionOfAnOutputNamesItAndTheFrame) {
  for (const auto& [how, what] :
       {std::pair{"exception", "threw std::runtime_error: the output is broken"},
        std::pair{"output_error", "): no room"}}) {
    const Outcome outcome = run_output(how);
    expect_named(outcome, "output 'failing'", "libhypotrack_output_failing.so", what);
    EXPECT_THAT(outcome.err, HasSubstr("hypotrack: frame 3: "));
  }
}

TEST_F(PluginErrorsTest, AParameterThatTheSceneReadsItselfIsRefused) {
  const Outcome outcome = run_with(replaced(box_scene(), "stereo_color", "weighty"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("scene.yaml:8:12: objective 'weighty' ("),
                    HasSubstr("its parameter 'weight' has a name that scenes take for every")));
}

TEST_F(PluginErrorsTest, ACrashNamesThePluginAndTheFrame) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer reports crashes in its own way";
#endif
  for (const auto& [kind, outcome] :
       {std::pair{"optimizer", run_optimizer("segfault")},
        std::pair{"objective", run_objective("segfault")},
        std::pair{"model", run_model("segfault")}, std::pair{"output", run_output("segfault")},
        std::pair{"judge", run_judge("segfault")},
        std::pair{"optimizer", run_optimizer("stack_overflow")},
        std::pair{"objective", run_objective("stack_overflow")}}) {
    EXPECT_EQ(outcome.exit_code, 128 + SIGSEGV) << kind;
    EXPECT_THAT(outcome.err,
                testing::ContainsRegex(
                    std::string("hypotrack: frame [0-4]: [^ ]*scene.yaml:[0-9]+:[0-9]+: ") + kind +
                    " 'failing' .*_failing.so\\): crashed"));
  }
  const Outcome outcome = run_source("segfault");
  EXPECT_EQ(outcome.exit_code, 128 + SIGSEGV);
  EXPECT_THAT(outcome.err, testing::ContainsRegex("hypotrack: after frame 2: .*scene.yaml:3:3: "
                                                  "source 'failing' .*_failing.so\\): crashed"));
}

TEST_F(PluginErrorsTest, AProgramThatAPluginEndsSaysSoAndFails) {
  const Outcome late = run_optimizer("exit");
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_THAT(late.err, testing::ContainsRegex("hypotrack: frame [0-4]: .*optimizer 'failing' .*: "
                                               "ended the program by exit\\(\\) before"));
  std::filesystem::remove_all(path("out"));
  const Outcome early = run_optimizer("exit", -1);
  EXPECT_EQ(early.exit_code, 1);
  EXPECT_THAT(early.err,
              AllOf(HasSubstr("scene.yaml:9:12: optimizer 'failing': ended the program by exit()"),
                    HasSubstr("while it was made")));
}

}  // namespace
}  // namespace hypotrack::test
