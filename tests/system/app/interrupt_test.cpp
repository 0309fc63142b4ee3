#include "interrupt.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

class InterruptTest : public AppTest {
 protected:
  /// A run that lasts until it is stopped.
  Start long_run(bool overlay = false) const {
    Start start;
    start.arguments = {"run",   scene(box_scene()),
                       "--out", path("out").string(),
                       "--set", "source.frames=1000000",
                       "--set", overlay ? "output.overlay=true" : "output.overlay=false"};
    return start;
  }

  /// Waits until a growing file has some lines.
  void wait_for_lines(Program& program, const std::string& name, std::size_t lines) const {
    while (program.running() && lines_of(read_text(path(name))).size() < lines)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(program.running()) << program.wait().err;
  }

  /// Every line of a table has as many cells as its header, and the last is ended.
  void expect_whole_lines(const std::filesystem::path& file) const {
    const std::string text = read_text(file);
    ASSERT_THAT(text, testing::EndsWith("\n"));
    const auto lines = lines_of(text);
    const auto cells = [](const std::string& line) {
      return std::count(line.begin(), line.end(), ',');
    };
    for (const std::string& line : lines) EXPECT_EQ(cells(line), cells(lines.front())) << line;
  }
};

TEST_F(InterruptTest, CtrlCFinishesTheFrameAndTheFiles) {
  Program program(long_run(true));
  wait_for_lines(program, "out/track.csv", 4);
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; the files hold the frames so far"));
  auto names = names_in(path("out"));
  // How many pictures of the worst frames there are depends on how far the run came.
  EXPECT_GT(std::erase_if(names, [](const auto& name) { return name.starts_with("worst_"); }), 0);
  EXPECT_THAT(names,
              ElementsAre("errors.csv", "joints.csv", "metrics.json", "overlay.mp4", "run.yaml",
                          "summary.json", "track.csv", "truth_landmarks.csv", "truth_states.csv"));
  expect_whole_lines(path("out/track.csv"));
  expect_whole_lines(path("out/joints.csv"));
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  EXPECT_EQ(summary.at("complete"), false);
  EXPECT_EQ(summary.at("frames").get<std::size_t>() + 1,
            lines_of(read_text(path("out/track.csv"))).size());
}

/// Is told to stop and goes on.
[[noreturn]] void hang(unsigned patience_s) {
  const app::InterruptGuard guard(patience_s);
  raise(SIGTERM);
  while (true) pause();
}

TEST(InterruptGuardDeathTest, EndsAProgramThatDoesNotAnswerASignal) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(hang(1), testing::ExitedWithCode(130), "was told to stop and did not answer");
}

TEST(InterruptGuardDeathTest, SaysFirstThatItWaits) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_EXIT(hang(4), testing::ExitedWithCode(130),
              "has not answered yet. Ctrl-C again ends it at once\n.*did not answer; ended now");
}

TEST(InterruptGuard, LeavesAProgramAloneThatAnswers) {
  const app::InterruptGuard guard(1);
  raise(SIGTERM);
  EXPECT_TRUE(guard.interrupted());
  EXPECT_EQ(alarm(0), 0U);  // nothing is scheduled any more
}

TEST(InterruptGuard, CtrlCIsForOthersIfItWasIgnored) {
  const auto before = std::signal(SIGINT, SIG_IGN);
  {
    const app::InterruptGuard guard;
    siginfo_t of_terminal{};
    of_terminal.si_code = SI_KERNEL;
    ASSERT_EQ(syscall(SYS_rt_sigqueueinfo, getpid(), SIGINT, &of_terminal), 0);
    EXPECT_FALSE(guard.interrupted());
    raise(SIGINT);
    EXPECT_TRUE(guard.interrupted());
  }
  EXPECT_EQ(std::signal(SIGINT, before), SIG_IGN);
}

TEST_F(InterruptTest, KillEndsARunThatAScriptStartedInTheBackground) {
  const std::string script =
      "\"$0\" run \"$1\" --out \"$2\" --set source.frames=1000000 >&2 &\n"
      "until [ \"$(cat \"$2/track.csv\" 2>/dev/null | wc -l)\" -gt 2 ]; do sleep 0.05; done\n"
      "kill -INT $!; wait $!; echo $?";
  const Captured said = capture_output({"/bin/sh",
                                        {"-c", script, (build_dir() / "bin" / "hypotrack").string(),
                                         scene(box_scene()), path("out").string()}},
                                       {1});
  EXPECT_EQ(said.output, "130\n");
  EXPECT_TRUE(std::filesystem::exists(path("out/summary.json")));
}

TEST_F(InterruptTest, AClosedTerminalFinishesTheFrameAndTheFiles) {
  Program program(long_run());
  wait_for_lines(program, "out/track.csv", 4);
  program.signal(SIGHUP);
  program.signal(SIGHUP);  // a shell passes on what it got, and the kernel tells all
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; the files hold the frames so far"));
  EXPECT_THAT(names_in(path("out")), Each(testing::Not(StartsWith(".part."))));
  expect_whole_lines(path("out/track.csv"));
}

TEST_F(InterruptTest, CtrlCThatEndsTheReaderOfItsOutputFinishesTheFiles) {
  const std::string pipe = path("pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  Start start = long_run();
  start.out = start.err = pipe;  // as `2>&1 | tee log`
  Program program(start);
  wait_for_lines(program, "out/track.csv", 4);
  close(reader);
  program.signal(SIGINT);
  EXPECT_NE(program.wait().exit_code, 0);
  EXPECT_THAT(names_in(path("out")), Each(testing::Not(StartsWith(".part."))));
  expect_whole_lines(path("out/track.csv"));
  EXPECT_EQ(nlohmann::json::parse(read_text(path("out/summary.json"))).at("complete"), false);
}

TEST_F(InterruptTest, ARunThatNobodyHearsGoesOn) {
  Start start;
  start.arguments = {"run", scene(box_scene()), "--out", path("out").string()};
  start.err = "/dev/full";
  EXPECT_EQ(run_program(start).exit_code, 0);
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(6));
}

TEST_F(InterruptTest, AnErrorThatNobodyHearsIsOneStill) {
  Start start;
  start.arguments = {"run", path("none.yaml").string(), "--out", path("out").string()};
  start.err = "/dev/full";
  EXPECT_EQ(run_program(start).exit_code, 1);
}

TEST_F(InterruptTest, CtrlCLeavesTheFramesThatSmoothingStillWaitedFor) {
  Start start = long_run();
  for (const char* set : {"smoothing.fixed_lag.enabled=true", "budget.evaluations=256"})
    start.arguments.insert(start.arguments.end(), {"--set", set});
  Program program(start);
  wait_for_lines(program, "out/online.csv", 4);
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_EQ(lines_of(read_text(path("out/track.csv"))).size(),
            lines_of(read_text(path("out/online.csv"))).size());
  expect_whole_lines(path("out/track.csv"));
}

TEST_F(InterruptTest, AKilledRunLeavesWholeLinesAndTheNextCleansUp) {
  {
    Program program(long_run());
    wait_for_lines(program, "out/track.csv", 4);
    program.signal(SIGKILL);
    EXPECT_EQ(program.wait().exit_code, 128 + SIGKILL);
  }
  EXPECT_THAT(names_in(path("out")), testing::Not(testing::Contains("summary.json")));
  expect_whole_lines(path("out/track.csv"));
  EXPECT_THAT(run_program({"evaluate", path("out").string()}).err,
              HasSubstr("the run has not ended, or was killed"));
  const Outcome outcome = run(box_scene());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(names_in(path("out")),
              ElementsAre("errors.csv", "joints.csv", "metrics.json", "run.yaml", "summary.json",
                          "track.csv", "truth_landmarks.csv", "truth_states.csv",
                          testing::MatchesRegex("worst_[0-4]\\.jpg")));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(6));
}

TEST_F(InterruptTest, AKilledRunKeepsTheEarlierResultUntilAnotherOneEnds) {
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  const std::string earlier = read_text(path("out/track.csv"));
  const auto names = names_in(path("out"));
  Program program(long_run());
  wait_for_lines(program, "out/track.csv", 8);  // the earlier one has 6
  program.signal(SIGKILL);
  program.wait();
  EXPECT_EQ(names_in(path("out/.previous")), names);
  EXPECT_EQ(read_text(path("out/.previous/track.csv")), earlier);
  EXPECT_EQ(run_program({"evaluate", path("out/.previous").string()}).exit_code, 0);
  EXPECT_THAT(run_program({"evaluate", path("out").string()}).err,
              HasSubstr("the run has not ended, or was killed"));
  EXPECT_EQ(run("models: 1\n").exit_code, 1);
  EXPECT_EQ(read_text(path("out/.previous/track.csv")), earlier);
  ASSERT_EQ(run(box_scene()).exit_code, 0);
  EXPECT_EQ(names_in(path("out")), names);
}

class FailingPluginTest : public InterruptTest {
 protected:
  Outcome fail(const std::string& optimizer) const {
    return run(with_optimizer(optimizer),
               {"--plugin-path", fixtures(), "--set", "recovery.enabled=false"});
  }
  static std::string with_optimizer(const std::string& optimizer) {
    return replaced(box_scene(), "{type: pso, particles: 8, generations: 4}", optimizer);
  }
  static std::string fixtures() { return (build_dir() / "tests/plugin_fixtures/app").string(); }
};

/// Ctrl-C in the middle of the third frame, which would take more than a minute.
class LongFrameTest : public FailingPluginTest, public testing::WithParamInterface<const char*> {};

INSTANTIATE_TEST_SUITE_P(Interrupt, LongFrameTest, testing::Values("endless", "long_batch"));

TEST_P(LongFrameTest, CtrlCEndsTheFrameAndKeepsThoseBefore) {
  Start start = long_run();
  scene(with_optimizer(std::string("{type: failing, frames: 2, how: ") + GetParam() + "}"));
  start.arguments.insert(start.arguments.begin(), {"--plugin-path", fixtures()});
  start.arguments.insert(start.arguments.end(), {"--set", "recovery.enabled=false"});
  Program program(start);
  wait_for_lines(program, "out/track.csv", 3);
  const auto begin = std::chrono::steady_clock::now();
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; the files hold the frames so far"));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("failing")));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(3));
  expect_whole_lines(path("out/joints.csv"));
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  EXPECT_EQ(summary.at("complete"), false);
  EXPECT_EQ(summary.at("frames"), 2);
}

TEST_F(FailingPluginTest, AnExceptionKeepsTheFramesSoFar) {
  const Outcome outcome = fail("{type: failing, frames: 2}");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the search is broken"));
  EXPECT_THAT(outcome.err, HasSubstr("holds the frames so far"));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(3));
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  EXPECT_EQ(summary.at("complete"), false);
  EXPECT_EQ(summary.at("frames"), 2);
}

TEST_F(FailingPluginTest, AnythingThrownIsReported) {
  const Outcome outcome = fail("{type: failing, frames: 1, how: int}");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("threw int, which is no std::exception"));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(2));
}

TEST_F(FailingPluginTest, AnExceptionOnTheFirstFrameLeavesNothing) {
  const Outcome outcome = fail("{type: failing, frames: 0}");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the search is broken"));
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(FailingPluginTest, ACrashLeavesWholeLinesOfAnUnfinishedRun) {
  const Outcome outcome = fail("{type: failing, frames: 2, how: segfault}");
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_NE(outcome.exit_code, 1);
  EXPECT_THAT(names_in(path("out")), testing::Not(testing::Contains("summary.json")));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(3));
  expect_whole_lines(path("out/track.csv"));
}

TEST_F(InterruptTest, CtrlCLeavesAShorterRecording) {
  Start start;
  start.arguments = {"synth", scene(box_scene()),     "--out", path("recording").string(),
                     "--set", "source.frames=1000000"};
  Program program(start);
  while (program.running() && names_in(path(".part.recording")).size() < 6)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the recording ends early"));
  EXPECT_FALSE(std::filesystem::exists(path(".part.recording")));
  const Outcome tracked = run_program({"run", path("recording/scene.yaml").string(), "--out",
                                       path("out").string(), "--frames", "2"});
  EXPECT_EQ(tracked.exit_code, 0) << tracked.err;
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(3));
}

}  // namespace
}  // namespace hypotrack::test
