#include <sys/socket.h>

#include <array>
#include <chrono>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "app_test.hpp"
#include "base/descriptor.hpp"
#include "cost/cuda/device.hpp"
#include "run/crew/job.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class RunSeveralTest : public AppTest {
 protected:
  static std::string quiet(const std::string& scene) {
    return replaced(scene, "{overlay: false}", "{overlay: false, worst_frames: 0}");
  }

  Outcome run_several(const std::vector<std::string>& scenes,
                      const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"--plugin-path",
                                       (build_dir() / "tests/plugin_fixtures/app").string(), "run",
                                       "--out", path("out").string()};
    arguments.insert(arguments.end(), scenes.begin(), scenes.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }

  std::string failing(const std::string& how) const {
    return replaced(box_scene(), "{type: pso, particles: 8, generations: 4}",
                    "{type: failing, frames: 1, how: " + how + "}");
  }
};

TEST_F(RunSeveralTest, EachSceneIsTrackedAsByItself) {
  const std::string first = scene(quiet(box_scene()), "first.yaml");
  const std::string second = scene(quiet(box_scene()) + "seed: 4\n", "second.yaml");
  std::filesystem::create_directory(path("third"));
  const std::string third = scene(quiet(box_scene()) + "seed: 5\n", "third/scene.yaml");
  const Outcome outcome = run_several({first, second, third}, {"--jobs", "2", "--frames", "3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(names_in(path("out")), testing::ElementsAre("first", "second", "third"));
  for (const auto& [name, file] :
       {std::pair{"first", first}, {"second", second}, {"third", third}}) {
    const auto alone = path("alone") / name;
    ASSERT_EQ(run_program({"run", file, "--out", alone.string(), "--frames", "3"}).exit_code, 0);
    EXPECT_EQ(track_without_times(path("out") / name), track_without_times(alone)) << name;
    EXPECT_THAT(outcome.err, HasSubstr(std::string(name) + ":\ntracking with "));
    EXPECT_THAT(outcome.out, HasSubstr(std::string(name) + ":\n3 frames ("));
  }
}

TEST_F(RunSeveralTest, EqualNamesAreRefusedBeforeAnythingRuns) {
  std::filesystem::create_directory(path("other"));
  expect_refusal(run_several({scene(box_scene(), "a.yaml"), scene(box_scene(), "other/a.yaml")}),
                 {"a.yaml and ", "other/a.yaml would both write into ", "/out/a; rename one"});
}

TEST_F(RunSeveralTest, AMistakeInOneSceneIsFoundBeforeAnythingRuns) {
  expect_refusal(run_several({scene(box_scene(), "a.yaml"),
                              scene(replaced(box_scene(), "tile:", "tiel:"), "b.yaml")}),
                 {"b.yaml:", "did you mean 'tile'"});
}

TEST_F(RunSeveralTest, AFailedRunIsNamedAndTheOthersAreMade) {
  for (const auto& [how, why] :
       {std::pair{"exception", "the search is broken"}, {"segfault", "crashed"}}) {
    const Outcome outcome = run_several(
        {scene(failing(how), "bad.yaml"), scene(box_scene(), "good.yaml")}, {"--jobs", "2"});
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("failed: bad: frame "), HasSubstr(why),
                                   HasSubstr("hypotrack: 1 of 2 runs failed: bad\n")));
    EXPECT_TRUE(std::filesystem::exists(path("out/good/track.csv"))) << how;
  }
}

TEST_F(RunSeveralTest, OneSceneWithJobsHasAFolderToo) {
  EXPECT_EQ(run_several({scene(box_scene(), "a.yaml")}, {"--jobs", "1"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("out/a/track.csv")));
}

TEST_F(RunSeveralTest, ViewersShowOneRun) {
  expect_refusal(
      run_several({scene(box_scene(), "a.yaml"), scene(box_scene(), "b.yaml")}, {"--preview"}),
      {"--preview and --web show one run"});
}

TEST_F(RunSeveralTest, WithoutAGpuTheirChoiceIsRefused) {
  const std::string why = cuda::why_no_device();
  if (why.empty()) GTEST_SKIP() << "needs a machine without a GPU";
  for (const char* list : {"all", "auto", "0,1"})
    expect_refusal(run_several({scene(box_scene(), "a.yaml")}, {"--gpus", list}),
                   {std::string("--gpus ") + list + ": " + why + "; leave --gpus out"});
  EXPECT_EQ(run_several({scene(box_scene(), "a.yaml")}, {"--gpus", "first"}).exit_code, 1);
}

TEST_F(RunSeveralTest, WithoutAFolderForTemporaryFilesItSaysWhich) {
  Start start;
  start.arguments = {"run", scene(box_scene()), "--jobs", "1", "--out", path("out").string()};
  start.environment = {"TMPDIR=" + path("absent").string()};
  expect_refusal(run_program(start), {"TMPDIR=" + path("absent").string() +
                                      ": cannot make a temporary folder there: "
                                      "No such file or directory; set TMPDIR"});
}

TEST_F(RunSeveralTest, TheCommandOfAWorkerIsNotForUsers) {
  expect_refusal(run_program({"work", "--gpu", "0"}), {"work: descriptor 3 is no socket"});
}

/// A test with runs that last until they are stopped.
class InterruptedRunsTest : public RunSeveralTest {
 protected:
  std::string endless(const std::string& name, const std::string& text) const {
    return scene(replaced(quiet(text), "synthetic\n", "synthetic\n  frames: 1000000\n"), name);
  }
  Start start(const std::vector<std::string>& scenes) const {
    Start start;
    start.arguments = {"--plugin-path",
                       (build_dir() / "tests/plugin_fixtures/app").string(),
                       "run",
                       "--out",
                       path("out").string(),
                       "--jobs",
                       "2"};
    start.arguments.insert(start.arguments.end(), scenes.begin(), scenes.end());
    start.err = path("err.txt");
    std::filesystem::create_directory(path("tmp"));
    start.environment = {"TMPDIR=" + path("tmp").string()};
    return start;
  }
  /// Waits until a file has a text in it.
  void wait_for(Program& program, const std::string& name, const std::string& text) const {
    while (program.running() && read_text(path(name)).find(text) == std::string::npos)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(program.running()) << read_text(path("err.txt"));
  }
};

TEST_F(InterruptedRunsTest, FramesSoFarAreKeptAndRunsThatDidNotBeginAreNamed) {
  Program program(start({endless("a.yaml", box_scene()), endless("b.yaml", box_scene()),
                         endless("c.yaml", box_scene())}));
  for (const char* table : {"out/a/track.csv", "out/b/track.csv"}) wait_for(program, table, "\n1,");
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(read_text(path("err.txt")),
              testing::EndsWith("hypotrack: interrupted; the files of a, b hold the frames so far; "
                                "c did not begin\n"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("a:\n"), HasSubstr("results in "), HasSubstr("b:\n")));
  EXPECT_THAT(names_in(path("out")), testing::ElementsAre("a", "b"));
  EXPECT_TRUE(std::filesystem::exists(path("out/a/summary.json")));
}

TEST_F(InterruptedRunsTest, RunsThatDoNotAnswerAreNamedAndASecondCtrlCEndsThem) {
  Program program(start({endless("a.yaml", box_scene()), endless("deaf.yaml", failing("hang"))}));
  wait_for(program, "out/deaf/track.csv", "frame,");
  ASSERT_EQ(names_in(path("tmp")).size(), 1U);
  wait_for(program, "tmp/" + names_in(path("tmp")).front() + "/1.txt", "hangs");
  program.signal(SIGINT);
  wait_for(program, "err.txt", "waiting for deaf; Ctrl-C again ends it at once\n");
  program.signal(SIGINT);
  EXPECT_EQ(program.wait().exit_code, 128 + SIGINT);
  Start next = start({path("a.yaml").string()});
  next.arguments.insert(next.arguments.end(), {"--frames", "1"});
  EXPECT_EQ(run_program(next).exit_code, 0) << read_text(path("err.txt"));
  EXPECT_THAT(names_in(path("tmp")), testing::IsEmpty());
}

/// A test with a worker that tracks in threads of one process, without a GPU.
class WorkerTest : public RunSeveralTest {
 protected:
  void start() {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
    socket_.emplace(ends[0]);
    const Descriptor other(ends[1]);
    Subprocess::Command command{.program = build_dir() / "bin/hypotrack"};
    command.arguments = {"--plugin-path", (build_dir() / "tests/plugin_fixtures/app").string(),
                         "work"};
    command.descriptors = {{other.get(), kWorkerSocket}};
    command.errors = path("errors.txt");
    worker_.emplace(command);
    EXPECT_EQ(answer()->kind, WorkerAnswer::Kind::ready);
  }

  void give(std::size_t key, const std::string& scene, double limit_s = 0) {
    const std::string name = std::to_string(key);
    const std::string line = line_of({.key = key,
                                      .scene = scene,
                                      .set = {"seed=" + name, "evaluate.threads=1"},
                                      .out = path("out_" + name),
                                      .log = path("log_" + name)},
                                     limit_s) +
                             "\n";
    ASSERT_EQ(send(socket_->get(), line.data(), line.size(), 0), static_cast<ssize_t>(line.size()));
  }

  /// Returns the next answer; nothing after the last.
  std::optional<WorkerAnswer> answer() {
    for (;;) {
      if (const auto line = lines_.next()) return parse_answer(*line);
      std::array<char, 256> chunk;
      const ssize_t size = recv(socket_->get(), chunk.data(), chunk.size(), 0);
      if (size <= 0) return std::nullopt;
      lines_.add(chunk.data(), static_cast<std::size_t>(size));
    }
  }

  std::map<std::size_t, WorkerAnswer> answers() {
    shutdown(socket_->get(), SHUT_WR);
    std::map<std::size_t, WorkerAnswer> all;
    while (const auto one = answer()) all[one->key] = *one;
    return all;
  }

  std::string log(std::size_t key) const { return read_text(path("log_" + std::to_string(key))); }

  std::optional<Descriptor> socket_;
  std::optional<Subprocess> worker_;
  LineBuffer lines_;
};

TEST_F(WorkerTest, ThreadsOfOneProcessTrackAsProcessesDo) {
  const std::string box = scene(quiet(box_scene()));
  start();
  for (std::size_t key = 1; key <= 4; ++key) give(key, box);
  const auto all = answers();
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(worker_->wait().code, 0) << read_text(path("errors.txt"));
  for (const auto& [key, end] : all) {
    EXPECT_EQ(end.code, 0) << log(key);
    EXPECT_THAT(log(key), AllOf(HasSubstr("tracking with cpu"), HasSubstr("results in ")));
    const auto alone = path("alone_" + std::to_string(key));
    ASSERT_EQ(
        run_program({"run", box, "--out", alone.string(), "--seed", std::to_string(key)}).exit_code,
        0);
    EXPECT_EQ(track_without_times(path("out_" + std::to_string(key))), track_without_times(alone));
  }
}

TEST_F(WorkerTest, AnErrorIsOfOneRun) {
  start();
  give(1, scene(failing("exception"), "bad.yaml"));
  give(2, scene(box_scene(), "good.yaml"));
  give(3, path("absent.yaml").string());
  auto all = answers();
  EXPECT_EQ(all[1].code, 1);
  EXPECT_THAT(log(1), HasSubstr("hypotrack: frame "));
  EXPECT_EQ(all[2].code, 0) << log(2);
  EXPECT_EQ(all[3].code, 1);
  EXPECT_THAT(log(3), HasSubstr("hypotrack: "));
  EXPECT_THAT(log(3), HasSubstr("absent.yaml"));
}

TEST_F(WorkerTest, ARunEndsItselfAtItsTimeLimit) {
  start();
  give(1,
       scene(replaced(box_scene(), "synthetic\n", "synthetic\n  frames: 1000000\n"), "long.yaml"),
       0.3);
  give(2, scene(failing("endless"), "endless.yaml"), 0.3);
  auto all = answers();
  EXPECT_EQ(all[1].kind, WorkerAnswer::Kind::overdue) << log(1);
  EXPECT_EQ(all[2].kind, WorkerAnswer::Kind::overdue) << log(2);
}

TEST_F(WorkerTest, ASignalEndsAllRunsAndKeepsTheirFrames) {
  const std::string box = scene(
      replaced(quiet(box_scene()), "synthetic\n", "synthetic\n  frames: 1000000\n"), "long.yaml");
  start();
  for (const std::size_t key : {1, 2}) give(key, box);
  for (const char* name : {"out_1", "out_2"})
    while (!std::filesystem::exists(path(name) / "track.csv")) {
      ASSERT_TRUE(worker_->running()) << read_text(path("errors.txt"));
    }
  worker_->signal(SIGINT);
  auto all = answers();
  for (const std::size_t key : {1, 2}) {
    EXPECT_EQ(all[key].code, 130);
    EXPECT_THAT(log(key), HasSubstr("hypotrack: interrupted"));
  }
  EXPECT_EQ(worker_->wait().code, 0);
}

}  // namespace
}  // namespace hypotrack::test
