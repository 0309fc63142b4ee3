#include <nlohmann/json.hpp>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

struct Case {
  const char* fault;
  const char* optimizer;
};

/// A test with a device that fails at one of its calls: early, late, in a frame, between two.
class FailingDeviceTest : public AppTest, public testing::WithParamInterface<Case> {
 protected:
  static constexpr int kFrames = 5;

  Outcome run_with_fault_at(int call, const std::string& on_loss) const {
    std::filesystem::remove_all(path("out"));
    const std::string text =
        replaced(box_scene(), "{type: pso, particles: 8, generations: 4}", GetParam().optimizer) +
        "evaluate: {backend: cuda, on_device_loss: " + on_loss + "}\n";
    Start start;
    start.arguments = {
        "run", scene(text), "--out", path("out").string(), "--set", "recovery.enabled=false"};
    start.environment = {std::string("CUDA_ON_CPU_FAULT=") + GetParam().fault + ":" +
                         std::to_string(call)};
    return run_program(start);
  }

  int frames() const {
    return static_cast<int>(lines_of(read_text(path("out/track.csv"))).size()) - 1;
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(read_text(path("out/summary.json")));
  }
  void expect_no_half_written_files() const {
    for (const std::string& name : names_in(path("out")))
      EXPECT_THAT(name, Not(HasSubstr(".part")));
  }
};

TEST_P(FailingDeviceTest, IsSaidOnceAndTheFramesBeforeStay) {
  int call = 0, failed = 0, kept = 0;
  for (;; call = std::max(call + 1, call * 3 / 2)) {
    SCOPED_TRACE(call);
    const Outcome outcome = run_with_fault_at(call, "stop");
    if (outcome.exit_code == 0) break;  // it has fewer calls
    ++failed;
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    const auto lines = lines_of(outcome.err);
    EXPECT_EQ(std::ranges::count_if(
                  lines, [](const std::string& line) { return line.starts_with("hypotrack: "); }),
              1)
        << outcome.err;
    EXPECT_THAT(outcome.err, AnyOf(HasSubstr("out of memory"), HasSubstr("launch failure")));
    EXPECT_THAT(outcome.err, Not(HasSubstr("unexpected error")));
    expect_no_half_written_files();
    if (!std::filesystem::exists(path("out"))) continue;
    ++kept;
    EXPECT_GT(frames(), 0);
    EXPECT_EQ(summary().at("complete"), false);
    EXPECT_EQ(summary().at("frames"), frames());
  }
  EXPECT_EQ(frames(), kFrames);
  EXPECT_GT(failed, 3);
  if (GetParam().fault == std::string("lost")) {
    EXPECT_GT(kept, 0);
  }
}

class ReplacedDeviceTest : public FailingDeviceTest {};

TEST_P(ReplacedDeviceTest, OnceFramesWereTrackedTheCpuGoesOnIfAskedTo) {
  int went_on = 0;
  for (int call = 0;; call = std::max(call + 1, call * 3 / 2)) {
    SCOPED_TRACE(call);
    const Outcome outcome = run_with_fault_at(call, "cpu");
    expect_no_half_written_files();
    if (outcome.exit_code != 0) {
      EXPECT_EQ(went_on, 0) << "a later call ends the run: " << outcome.err;
      EXPECT_FALSE(std::filesystem::exists(path("out"))) << outcome.err;
      continue;
    }
    EXPECT_EQ(frames(), kFrames);
    EXPECT_EQ(summary().at("complete"), true);
    if (outcome.err.find("goes on with the CPU") == std::string::npos) break;
    ++went_on;
  }
  EXPECT_GT(went_on, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Cuda, FailingDeviceTest,
    testing::Values(Case{"lost", "{type: pso, particles: 8, generations: 4}"},
                    Case{"memory", "{type: pso, particles: 8, generations: 4}"},
                    Case{"lost", "{type: pso_cuda, particles: 8, generations: 4}"},
                    Case{"memory", "{type: pso_cuda, particles: 8, generations: 4}"},
                    Case{"lost", "{type: levenberg_marquardt}"},
                    Case{"memory", "{type: levenberg_marquardt}"}));

// pso_cuda is refused there: it searches on a GPU only.
INSTANTIATE_TEST_SUITE_P(Cuda, ReplacedDeviceTest,
                         testing::Values(Case{"lost", "{type: pso, particles: 8, generations: 4}"},
                                         Case{"memory",
                                              "{type: pso, particles: 8, generations: 4}"},
                                         Case{"lost", "{type: levenberg_marquardt}"},
                                         Case{"memory", "{type: levenberg_marquardt}"}));

}  // namespace
}  // namespace hypotrack::test
