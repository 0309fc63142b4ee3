#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class RepeatTest : public AppTest {
 protected:
  /// Runs a scene file into a folder and returns what was tracked.
  std::string track(const std::string& file, const std::string& out,
                    const std::vector<std::string>& more = {},
                    const std::filesystem::path& directory = {}) const {
    Start start;
    start.arguments = {"run", file, "--out", path(out).string()};
    start.arguments.insert(start.arguments.end(), more.begin(), more.end());
    start.directory = directory;
    const Outcome outcome = run_program(start);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return track_without_times(path(out));
  }

  /// The protocol of the run in `out`, run again.
  std::string repeat(const std::string& out) const {
    return track(path(out + "/run.yaml").string(), out + "_again");
  }
};

TEST_F(RepeatTest, SameSeedSameBytesAndAnotherSeedOthers) {
  const std::string file = scene(box_scene());
  const std::string first = track(file, "a", {"--seed", "7"});
  EXPECT_EQ(track(file, "b", {"--seed", "7"}), first);
  EXPECT_NE(track(file, "c", {"--seed", "8"}), first);
  std::vector<std::string> names = names_in(path("a"));
  EXPECT_EQ(names, names_in(path("b")));
  for (const char* timed : {"track.csv", "summary.json"}) std::erase(names, timed);
  ASSERT_THAT(names, testing::Contains("metrics.json"));
  for (const std::string& name : names)
    EXPECT_EQ(read_text(path("a/" + name)), read_text(path("b/" + name))) << name;
}

TEST_F(RepeatTest, ThreadsDoNotChangeTheResult) {
  const std::string file = scene(box_scene());
  const std::string one = track(file, "one", {"--set", "evaluate.threads=1"});
  EXPECT_EQ(track(file, "three", {"--set", "evaluate.threads=3"}), one);
}

TEST_F(RepeatTest, ProtocolRepeatsTheRunWithSeedAndOverrides) {
  const std::string first =
      track(scene(box_scene()), "out", {"--seed", "9", "--set", "optimizer.particles=6"});
  EXPECT_EQ(repeat("out"), first);
  EXPECT_EQ(read_text(path("out/run.yaml")), read_text(path("out_again/run.yaml")));
}

TEST_F(RepeatTest, ProtocolHoldsEveryParameterOfAStart) {
  const std::string file = scene(box_scene());
  track(file, "labels");
  EXPECT_THAT(read_text(path("labels/run.yaml")),
              HasSubstr("init:\n  from: truth\n  file: \"\"\n  frame: 0\n"));
  const std::string first = track(
      file, "out",
      {"--set", "init.from={type: landmarks, file: " + path("labels/joints.csv").string() + "}"});
  EXPECT_THAT(read_text(path("out/run.yaml")),
              HasSubstr("  from:\n    type: landmarks\n    file: "));
  EXPECT_EQ(repeat("out"), first);
  EXPECT_EQ(read_text(path("out/run.yaml")), read_text(path("out_again/run.yaml")));
}

TEST_F(RepeatTest, ProtocolHoldsEveryParameterOfAModelMadeByDefault) {
  const std::string text =
      replaced(replaced(box_scene(), "{name: box, type: rigid_box, size_mm: [90, 60, 40]}",
                        "{name: box, type: mirrored_hand}"),
               "frame: 4", "frame: 1");
  const std::string first = track(scene(text), "out");
  EXPECT_EQ(repeat("out"), first);
  const std::string protocol = read_text(path("out/run.yaml"));
  const auto of = protocol.find("of:\n");
  ASSERT_NE(of, std::string::npos) << protocol;
  const auto hand = protocol.find("type: hand\n", of);
  const auto name = protocol.find("name: box", of);
  EXPECT_LT(hand, name);
  EXPECT_THAT(protocol.substr(of, name - of), HasSubstr("mesh: "));
}

TEST_F(RepeatTest, ProtocolRunsFromAnotherFolderWithRelativePaths) {
  const std::string recording = path("recording").string();
  ASSERT_EQ(run_program({"synth", scene(box_scene()), "--out", recording}).exit_code, 0);
  std::filesystem::create_directory(path("elsewhere"));
  const std::string first = track("recording/scene.yaml", "out",
                                  {"--set", "source.left=recording/left_%06d.png", "--set",
                                   "source.right=recording/right_%06d.png"},
                                  folder());
  EXPECT_EQ(track("../out/run.yaml", "again", {}, path("elsewhere")), first);
  EXPECT_THAT(read_text(path("out/run.yaml")), Not(HasSubstr("left: recording")));
}

}  // namespace
}  // namespace hypotrack::test
