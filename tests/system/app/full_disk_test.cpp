#include <algorithm>

#include "app_test.hpp"
#include "hypotrack/api/image_file.hpp"

namespace hypotrack::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

/// Runs the program on a small disk of its own, a file system in memory.
class FullDiskTest : public AppTest {
 protected:
  void SetUp() override {
    if (on_disk(64, "true").exit_code != 0)
      GTEST_SKIP() << "this machine lets users mount no file systems in a namespace (unshare -rm)";
    std::filesystem::remove_all(path("kept"));
  }

  /// Calls a shell command with $disk, a disk of some KiB. Copies what it leaves there to
  /// folder/kept.
  Outcome on_disk(int kib, const std::string& command) const {
    std::filesystem::create_directories(path("disk"));
    const std::string script = "disk=" + path("disk").string() +
                               "; mount -t tmpfs -o size=" + std::to_string(kib) +
                               "k none $disk || exit 99; " + command + "; code=$?; cp -r $disk " +
                               path("kept").string() + "; exit $code";
    Subprocess process({"/usr/bin/unshare",
                        {"-rm", "/bin/sh", "-c", script},
                        {},
                        folder(),
                        path("printed"),
                        path("said")});
    const int code = process.wait().code;
    return {code, read_text(path("printed")), read_text(path("said"))};
  }

  static std::string program() { return (build_dir() / "bin" / "hypotrack").string(); }

  void expect_one_message(const Outcome& outcome) const {
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("No space left on device"));
    const auto lines = lines_of(outcome.err);
    EXPECT_EQ(std::ranges::count_if(
                  lines, [](const std::string& line) { return line.starts_with("hypotrack: "); }),
              1)
        << outcome.err;
  }
};

class FullDiskOfOutputTest : public FullDiskTest,
                             public testing::WithParamInterface<const char*> {};

INSTANTIATE_TEST_SUITE_P(Outputs, FullDiskOfOutputTest,
                         testing::Values("[]", "{type: jsonl}", "{type: tum}", "{type: bvh}"));

TEST_P(FullDiskOfOutputTest, EndsTheRunWhichKeepsTheFramesBefore) {
  const std::string text = replaced(box_scene(), "{overlay: false}",
                                    std::string("{overlay: false, also: ") + GetParam() + "}");
  const Outcome outcome =
      on_disk(32, program() + " run " + scene(text) + " --out $disk/out --set source.frames=1000");
  expect_one_message(outcome);
  EXPECT_THAT(outcome.err, HasSubstr("the frames so far are in"));
  const auto names = names_in(path("kept/out"));
  EXPECT_THAT(names, testing::Not(Contains("summary.json")));
  const auto lines = lines_of(read_text(path("kept/out/track.csv")));
  EXPECT_GT(lines.size(), 5U);
  for (const char* table : {"track.csv", "joints.csv"})
    EXPECT_THAT(read_text(path("kept/out") / table), testing::EndsWith("\n")) << "a torn line";
}

TEST_F(FullDiskTest, LeavesNoHalfOfAPictureOfParticles) {
  const std::string text = replaced(box_scene(), "{overlay: false}",
                                    "{overlay: false, also: {type: particles, every: 1}}");
  const Outcome outcome =
      on_disk(64, program() + " run " + scene(text) + " --out $disk/out --set source.frames=1000");
  expect_one_message(outcome);
  EXPECT_THAT(outcome.err, HasSubstr("the picture cannot be written: No space left on device"));
  for (const std::string& name : names_in(path("kept/out"))) {
    if (!name.ends_with(".png")) continue;
    EXPECT_EQ(read_color(path("kept/out") / name).problem, "");
  }
}

TEST_F(FullDiskTest, KeepsTheFirstFramesOfARecording) {
  const Outcome outcome = on_disk(500, program() + " synth " + scene(box_scene()) +
                                           " --out $disk/recording --set source.frames=100");
  expect_one_message(outcome);
  EXPECT_THAT(outcome.err, HasSubstr("the image cannot be written: No space left on device"));
  EXPECT_THAT(outcome.err, HasSubstr("the recording ends early"));
  EXPECT_THAT(names_in(path("kept")), testing::ElementsAre("recording"));
  const Outcome tracked = run_program(
      {"run", path("kept/recording/scene.yaml").string(), "--out", path("out").string()});
  EXPECT_EQ(tracked.exit_code, 0) << tracked.err;
  EXPECT_THAT(tracked.out, HasSubstr(" 0 missing"));
}

class CutVideoTest : public AppTest {};

TEST_F(CutVideoTest, IsNoResult) {
  Start start;
  start.arguments = {"run",   scene(replaced(box_scene(), "{overlay: false}", "{worst_frames: 0}")),
                     "--out", path("out").string(),
                     "--set", "source.frames=30"};
  start.largest_file = 8192;  // more than each table, less than the video
  const Outcome outcome = run_program(start);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.err, HasSubstr("overlay.mp4: the video is cut off and may not play: File too "
                                     "large"));
  EXPECT_THAT(names_in(path("out")), Contains(".part.summary.json"));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(31));
}

}  // namespace
}  // namespace hypotrack::test
