#include "run/crew/crew.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <thread>

#include "cost/cuda/backend_text.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "run/crew/scratch_folder.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// A test with a crew whose workers do what worker.sh says.
class CrewTest : public testing::Test {
 protected:
  CrewSettings settings(int jobs, std::vector<int> gpus) const {
    return {.program = source_dir() / "tests/core/run/crew/worker.sh",
            .variables = {"PLAN=" + folder_.path().string()},
            .gpus = std::move(gpus),
            .jobs = jobs,
            .time_limit_s = 50};
  }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  void plan(const std::string& name, const std::string& text = "") const {
    std::ofstream(path(name)) << text;
  }

  Job job(std::size_t key, std::optional<int> gpu = 0) const {
    return {.key = key,
            .scene = std::to_string(key) + ".yaml",
            .out = path("out_" + std::to_string(key)),
            .log = path("log_" + std::to_string(key)),
            .gpu = gpu};
  }

  /// Makes jobs 0 to count - 1 and returns how they ended.
  std::map<std::size_t, Ended> make(Crew& crew, std::size_t count) {
    std::map<std::size_t, Ended> ended;
    std::size_t next = 0;
    while (next < count || crew.size() > 0) {
      while (next < count && crew.has_room()) crew.start(job(next++));  // dealt before any ends
      take(crew, ended);
    }
    return ended;
  }

  void take(Crew& crew, std::map<std::size_t, Ended>& ended) {
    const auto one = crew.take_ended();
    if (one) ended[one->key] = *one;
    for (const std::string& note : crew.take_notes()) notes_.push_back(note);
    if (!one) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  std::string message(const Ended& ended) const {
    return failure_message(path("log_" + std::to_string(ended.key)), ended);
  }

  /// Lines that workers wrote: GPU, key, device.
  std::vector<std::string> log() const {
    std::ifstream in(path("log"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }

  static std::vector<int> gpus_of(const std::map<std::size_t, Ended>& ended) {
    std::vector<int> gpus;
    for (const auto& [key, end] : ended) gpus.push_back(end.gpu.value_or(-1));
    return gpus;
  }

  TemporaryDirectory folder_;
  std::vector<std::string> notes_;
};

TEST_F(CrewTest, DealsRunsEvenlyToGpusAndNamesTheOneOfEach) {
  plan("hold_0", "3");
  plan("hold_2", "3");
  Crew crew(settings(6, {0, 2}));
  EXPECT_EQ(crew.start_gpus(true), "GPU 0 (model 0), GPU 2 (model 2)");
  const auto ended = make(crew, 6);
  for (const auto& [key, end] : ended) EXPECT_EQ(end.end.code, 0) << key;
  EXPECT_THAT(gpus_of(ended), UnorderedElementsAre(0, 0, 0, 2, 2, 2));
  for (const std::string& line : log()) EXPECT_EQ(line.front(), line.back()) << line;
}

TEST_F(CrewTest, WithoutAChoiceARunTakesItsOwnGpu) {
  Crew crew(settings(2, {}));
  crew.start(job(0, 3));
  crew.start(job(1, std::nullopt));
  std::map<std::size_t, Ended> ended;
  while (crew.size() > 0) take(crew, ended);
  EXPECT_THAT(gpus_of(ended), ElementsAre(3, -1));
  EXPECT_THAT(log(), UnorderedElementsAre(HasSubstr("3 0 "), "cpu 1.yaml"));
  EXPECT_EQ(read_whole(path("log_1")), "alone 1.yaml\n");
}

TEST_F(CrewTest, OneWorkerMakesTheRunsOfAGpu) {
  Crew crew(settings(1, {0}));
  make(crew, 5);
  EXPECT_THAT(log(), ElementsAre("0 0 0", "0 1 0", "0 2 0", "0 3 0", "0 4 0"));
}

TEST_F(CrewTest, ARunThatCrashesItsWorkerFailsAndTheOthersAreMadeAgain) {
  plan("hold_0", "3");
  plan("crash_1");
  Crew crew(settings(3, {0}));
  const auto ended = make(crew, 4);
  ASSERT_THAT(ended, SizeIs(4));
  for (const std::size_t good : {0, 2, 3}) EXPECT_EQ(ended.at(good).end.code, 0) << good;
  EXPECT_EQ(ended.at(1).end.signal, SIGSEGV);
  EXPECT_THAT(message(ended.at(1)),
              AllOf(HasSubstr("frame 3: optimizer 'x': crashed"), HasSubstr("ended by signal 11")));
  EXPECT_THAT(notes_,
              ElementsAre(testing::ContainsRegex("the worker of GPU 0 ended; its [23] runs")))
      << "3: the last one was given to it in the meantime";
}

TEST_F(CrewTest, ALostGpuGivesItsRunsToTheOthers) {
  plan("hold_1", "2");
  plan("lose_1");
  Crew crew(settings(4, {0, 1}));
  crew.start_gpus(true);
  const auto ended = make(crew, 8);
  ASSERT_THAT(ended, SizeIs(8));
  for (const auto& [key, end] : ended) EXPECT_EQ(end.end.code, 0) << key << message(end);
  int lost = 0;
  for (const std::string& line : log()) lost += line.starts_with("1 ");
  EXPECT_EQ(lost, 2);
  for (const int gpu : gpus_of(ended)) EXPECT_LE(gpu, 1);
  ASSERT_THAT(notes_, SizeIs(1));
  EXPECT_THAT(notes_[0], HasSubstr("GPU 1 is lost: it fell off the bus; it gives back"));
}

TEST_F(CrewTest, WithoutAGpuRunsFailAndSayWhy) {
  plan("hold_0", "2");
  plan("lose_0");
  Crew crew(settings(2, {0}));
  const auto ended = make(crew, 3);
  ASSERT_THAT(ended, SizeIs(3));
  int without = 0;
  for (const auto& [key, end] : ended)
    without += end.end.code == 1 &&
               message(end) == "no GPU is left for the run: GPU 0: it fell off the bus";
  EXPECT_GE(without, 2);  // the third may be the one that ended before
}

TEST_F(CrewTest, AFaultOfTheGpuThatOneRunCausesFailsThatRun) {
  plan("hold_0", "3");
  plan("fault_2");
  Crew crew(settings(3, {0}));
  const auto ended = make(crew, 3);
  EXPECT_EQ(ended.at(0).end.code, 0);
  EXPECT_EQ(ended.at(1).end.code, 0);
  EXPECT_EQ(ended.at(2).end.code, 1);
  EXPECT_THAT(log(), testing::Contains("0 2 0"));
}

TEST_F(CrewTest, AGpuThatDoesNotAnswerIsNamedOrLeftOut) {
  plan("absent_1");
  Crew strict(settings(2, {0, 1}));
  EXPECT_EQ(message_of<DeviceError>([&] { strict.start_gpus(true); }),
            "--gpus: GPU 1: it fell off the bus; `--gpus auto` leaves it out");
  Crew lenient(settings(2, {0, 1}));
  EXPECT_EQ(lenient.start_gpus(false), "GPU 0 (model 0); without GPU 1: it fell off the bus");
  EXPECT_THAT(gpus_of(make(lenient, 2)), ElementsAre(0, 0));
  plan("absent_0");
  Crew none(settings(2, {0, 1}));
  EXPECT_EQ(message_of<DeviceError>([&] { none.start_gpus(false); }),
            "--gpus: GPU 0: it fell off the bus; GPU 1: it fell off the bus; leave --gpus out");
}

TEST_F(CrewTest, ARunAtItsTimeLimitSaysSo) {
  plan("overdue_0");
  Crew crew(settings(1, {0}));
  const auto ended = make(crew, 1);
  EXPECT_EQ(message(ended.at(0)), "did not end within 50 s (--time-limit); ended there");
}

TEST_F(CrewTest, KilledJobsAreForgotten) {
  plan("wait_0");
  Crew crew(settings(2, {0}));
  crew.start(job(0));
  crew.start(job(1));
  std::map<std::size_t, Ended> ended;
  while (ended.empty()) take(crew, ended);
  EXPECT_EQ(ended.begin()->first, 1U);
  crew.kill();
  EXPECT_EQ(crew.size(), 0U);
  EXPECT_FALSE(crew.take_ended());
}

TEST_F(CrewTest, AnInterruptDropsRunsThatWait) {
  plan("wait_0");
  Crew crew(settings(3, {0}));
  crew.start(job(0));
  std::map<std::size_t, Ended> ended;
  while (log().empty()) take(crew, ended);
  crew.start(job(1));
  crew.interrupt();
  while (!ended.contains(1)) take(crew, ended);
  EXPECT_EQ(ended.at(1).end.code, 130);
  EXPECT_THAT(message(ended.at(1)), HasSubstr("interrupted before the first frame"));
}

TEST_F(CrewTest, AfterAnInterruptNoRunIsMadeAgain) {
  plan("hold_0", "2");
  plan("crash_1");
  Crew crew(settings(2, {0}));
  crew.start_gpus(true);
  crew.start(job(1));
  crew.start(job(2));
  std::map<std::size_t, Ended> ended;
  while (log().size() < 2) take(crew, ended);
  crew.interrupt();
  while (crew.size() > 0) take(crew, ended);
  EXPECT_THAT(log(), SizeIs(2));
  EXPECT_THAT(notes_, IsEmpty());
  for (const std::size_t key : {1, 2}) EXPECT_EQ(ended.at(key).end.code, 130) << key;
}

TEST_F(CrewTest, AnInterruptDropsRunsOfAWorkerThatStartsAnew) {
  plan("hold_0", "2");
  plan("crash_1");
  Crew crew(settings(2, {0}));
  crew.start_gpus(true);
  plan("silent_0");
  crew.start(job(1));
  crew.start(job(2));
  std::map<std::size_t, Ended> ended;
  while (log().size() < 3) take(crew, ended);
  ASSERT_EQ(log().back(), "0 silent");
  crew.interrupt();
  for (const std::size_t key : {1, 2}) {
    take(crew, ended);
    EXPECT_EQ(ended[key].end.code, 130) << key;
  }
  EXPECT_EQ(crew.size(), 0U);
  EXPECT_THAT(message(ended[1]), HasSubstr("interrupted after its worker had ended"));
}

TEST_F(CrewTest, AGpuThatIsLostWithoutRunsGivesNoneBack) {
  plan("exit_0");
  Crew crew(settings(1, {0}));
  crew.start_gpus(true);
  std::filesystem::remove(path("exit_0"));
  std::map<std::size_t, Ended> ended;
  while (notes_.empty()) take(crew, ended);
  EXPECT_THAT(notes_, ElementsAre("note: GPU 0 is lost: its worker ended with exit code 3"));
}

TEST(ScratchFolder, AFolderOfAKilledProcessIsRemovedByTheNextOne) {
  const TemporaryDirectory parent;
  const char* const variable = getenv("TMPDIR");
  const std::optional<std::string> before = variable ? std::optional(variable) : std::nullopt;
  setenv("TMPDIR", parent.path().c_str(), 1);
  const pid_t ended = fork();
  if (ended == 0) {
    const ScratchFolder left;
    _exit(0);
  }
  waitpid(ended, nullptr, 0);
  const auto of = [&](const std::string& name) { return parent.path() / name; };
  const std::string number = std::to_string(ended);
  const std::vector<std::string> others = {"hypotrack_XXXXXX", "hypotrack_test_abcdef",
                                           "hypotrack_1_abcdef", "hypotrack_" + number + "_abcde"};
  for (const std::string& name : others) std::filesystem::create_directory(of(name));
  {
    const ScratchFolder own;
    const ScratchFolder second;  // leaves the first one alone
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(parent.path()))
      names.push_back(entry.path().filename().string());
    std::vector<std::string> expected = others;
    for (const ScratchFolder* each : {&own, &second})
      expected.push_back(each->path().filename().string());
    EXPECT_THAT(names, testing::UnorderedElementsAreArray(expected));
  }
  setenv("TMPDIR", of("absent").c_str(), 1);
  EXPECT_EQ(message_of<OutputError>([] { const ScratchFolder none; }),
            "TMPDIR=" + of("absent").string() +
                ": cannot make a temporary folder there: No such file or directory; set TMPDIR to "
                "a folder with room");
  before ? setenv("TMPDIR", before->c_str(), 1) : unsetenv("TMPDIR");
}

TEST(JobLine, ReadsAsItWasWritten) {
  const Job job{.key = 7,
                .scene = "a \"scene\"\n.yaml",
                .set = {"seed=3", "judge={type: none}"},
                .out = "o",
                .log = "l",
                .frames = 5,
                .check = true};
  double limit_s = 0;
  const std::string line = line_of(job, 2.5);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const Job read = parse_job(line, limit_s);
  EXPECT_EQ(read.key, 7U);
  EXPECT_EQ(read.scene, job.scene);
  EXPECT_EQ(read.set, job.set);
  EXPECT_EQ(read.frames, 5);
  EXPECT_TRUE(read.check);
  EXPECT_EQ(limit_s, 2.5);
  EXPECT_THROW(parse_job("{}", limit_s), DataError);
  EXPECT_THROW(parse_answer("ready"), DataError);
  EXPECT_THROW(parse_answer(R"({"kind": "asleep"})"), DataError);
  EXPECT_THROW(line_of(Job{.scene = "\xff.yaml"}, 0), ConfigError);
}

TEST(JobLine, PiecesOfLinesWaitForTheirEnd) {
  LineBuffer lines;
  lines.add("one\ntw", 6);
  EXPECT_EQ(lines.next(), "one");
  EXPECT_EQ(lines.next(), std::nullopt);
  lines.add("o\n", 2);
  EXPECT_EQ(lines.next(), "two");
}

TEST(BackendText, NamesTheGpuForReaders) {
  const std::string text = cuda::backend_text("NVIDIA H200", 12);
  EXPECT_EQ(text, "cuda (NVIDIA H200, GPU 12)");
  EXPECT_EQ(cuda::gpu_in("a.yaml: ok: " + text + "; on the CPU: landmarks\n"), 12);
  for (const char* other : {"", "cpu (AVX2, 4 threads)", "egl (NVIDIA, CUDA interop)", "cuda (X)"})
    EXPECT_EQ(cuda::gpu_in(other), std::nullopt) << other;
}

TEST(GpuList, AWrongListSaysWhatIsExpected) {
  for (const char* text : {"", "0,", "a", "0,0", "-1", "0;1", "All"})
    EXPECT_THAT(message_of<ConfigError>([&] { parse_gpus(text); }),
                HasSubstr("expected all, auto, or different numbers"))
        << text;
}

}  // namespace
}  // namespace hypotrack::test
