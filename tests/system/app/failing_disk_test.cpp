#include <algorithm>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::StartsWith;

/// Runs the program with a disk that fails or is slow (failing_disk.cpp).
class FailingDiskTest : public AppTest {
 protected:
  /// Runs the program, whose disk `folder/disk` has a setting such as READ_ONLY_AFTER=20000.
  Outcome on_disk(const std::string& setting, const std::vector<std::string>& arguments) const {
    std::filesystem::create_directories(disk());
    Start start;
    start.arguments = arguments;
    start.environment = {"FAILING_DISK=" + disk().string(), setting,
                         "LD_PRELOAD=" + (build_dir() / "tests/support/failing_disk.so").string()};
    return run_program(start);
  }
  std::filesystem::path disk() const { return path("disk"); }

  std::vector<std::string> run_of(const std::string& text, int frames) const {
    return {"run",   scene(text),
            "--out", (disk() / "out").string(),
            "--set", "source.frames=" + std::to_string(frames)};
  }
};

TEST_F(FailingDiskTest, ThatBecomesReadOnlyKeepsTheFramesBefore) {
  const Outcome outcome = on_disk("READ_ONLY_AFTER=20000", run_of(box_scene(), 1000));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("the frames so far are in"),
                                 HasSubstr("cannot be written: Read-only file system")));
  const auto lines = lines_of(outcome.err);
  EXPECT_EQ(std::ranges::count_if(
                lines, [](const std::string& line) { return line.starts_with("hypotrack: "); }),
            1)
      << outcome.err;
  EXPECT_THAT(names_in(disk() / "out"), testing::Not(testing::Contains("summary.json")));
}

TEST_F(FailingDiskTest, ThatBecomesReadOnlyEndsARecording) {
  const Outcome outcome = on_disk("READ_ONLY_AFTER=50000",
                                  {"synth", scene(box_scene()), "--out",
                                   (disk() / "recording").string(), "--set", "source.frames=100"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("the image cannot be written: Read-only file system"));
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("/proc/")));
  EXPECT_THAT(names_in(disk()), Each(StartsWith(".part.")));
}

TEST_F(FailingDiskTest, ThatIsSlowIsSaidOnceAndChangesNoResult) {
  const Outcome outcome = on_disk("DELAY_MS=100", run_of(box_scene(), 10));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto lines = lines_of(outcome.err);
  EXPECT_EQ(std::ranges::count_if(lines,
                                  [](const std::string& line) {
                                    return line.starts_with("note: outputs have taken ");
                                  }),
            1)
      << outcome.err;
  ASSERT_EQ(run(box_scene(), {"--set", "source.frames=10"}).exit_code, 0);
  EXPECT_EQ(track_without_times(disk() / "out"), track_without_times(path("out")));
}

}  // namespace
}  // namespace hypotrack::test
