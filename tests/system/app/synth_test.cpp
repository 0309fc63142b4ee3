#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::Contains;
using testing::ElementsAre;

class SynthTest : public AppTest {
 protected:
  Outcome record(const std::string& text, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"synth", scene(text), "--out", path("out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(SynthTest, TrackingTheRecordingIsTrackingTheSource) {
  const Outcome recorded = record(box_scene());
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const auto names = names_in(path("out"));
  for (const char* name :
       {"calibration.yaml", "left_000000.png", "left_mask_000000.png", "right_000004.png",
        "motion.json", "scene.yaml", "truth_landmarks.csv", "truth_states.csv"})
    EXPECT_THAT(names, Contains(name));
  EXPECT_THAT(recorded.out, testing::HasSubstr("peak speed of "));
  ASSERT_EQ(
      run_program({"run", path("scene.yaml").string(), "--out", path("direct").string()}).exit_code,
      0);
  const Outcome tracked =
      run_program({"run", path("out/scene.yaml").string(), "--out", path("from_disk").string()});
  ASSERT_EQ(tracked.exit_code, 0) << tracked.err;
  EXPECT_EQ(track_without_times(path("from_disk")), track_without_times(path("direct")));
  EXPECT_EQ(read_text(path("from_disk/errors.csv")), read_text(path("direct/errors.csv")));
}

TEST_F(SynthTest, ARecordingThatIsMovedStartsFromItsCopyOfTheStartsFile) {
  const std::string pose = "box: {position_mm: [0, 0, 400], rotation_deg: [20, 35, 5]}\n";
  for (const char* init : {"init: {from: file, file: poses/mine.yaml}",
                           "init: {from: {type: file, file: poses/mine.yaml}}"}) {
    std::filesystem::create_directory(path("poses"));
    write_text(path("poses/mine.yaml"), pose);
    const Outcome outcome = record(replaced(box_scene(), "init: {from: truth}", init));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    std::filesystem::remove_all(path("poses"));
    std::filesystem::rename(path("out"), path("moved"));
    EXPECT_EQ(read_text(path("moved/start_mine.yaml")), pose);
    const Outcome run =
        run_program({"run", path("moved/scene.yaml").string(), "--out", path("tracked").string()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    std::filesystem::remove_all(path("moved"));
    std::filesystem::remove_all(path("tracked"));
  }
}

TEST_F(SynthTest, ARecordingKnowsWhatIsAbsent) {
  ASSERT_EQ(record(replaced(box_scene(), "type: synthetic",
                            "type: synthetic\n  faults: [{frames: [1, 2], kind: absent}]"))
                .exit_code,
            0);
  EXPECT_THAT(lines_of(read_text(path("out/truth_landmarks.csv")))[2],
              testing::EndsWith(",absent,absent,absent"));
  for (const auto& [name, file] :
       {std::pair("direct", "scene.yaml"), std::pair("from_disk", "out/scene.yaml")}) {
    const Outcome run = run_program({"run", path(file).string(), "--out", path(name).string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(read_text(path(name) / "truth_landmarks.csv"),
              read_text(path("out/truth_landmarks.csv")));
  }
  EXPECT_EQ(read_text(path("from_disk/metrics.json")), read_text(path("direct/metrics.json")));
}

TEST_F(SynthTest, ARecordingKeepsTheTimesOfFramesAroundAGap) {
  ASSERT_EQ(record(replaced(box_scene(), "type: synthetic",
                            "type: synthetic\n  faults: [{frames: [2, 3], kind: missing}]"))
                .exit_code,
            0);
  EXPECT_THAT(names_in(path("out")), Contains("left_000002.png"));
  EXPECT_THAT(names_in(path("out")), testing::Not(Contains("left_000003.png")));
  EXPECT_EQ(read_text(path("out/times.csv")),
            "frame,time\n0,0.000000000\n1,0.033333333\n2,0.133333333\n");
  const Outcome again =
      run_program({"synth", path("out/scene.yaml").string(), "--out", path("again").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_text(path("again/times.csv")), read_text(path("out/times.csv")));
  EXPECT_EQ(read_text(path("again/left_000002.png")), read_text(path("out/left_000002.png")));
  EXPECT_EQ(run_program({"run", path("out/scene.yaml").string(), "--out", path("run").string()})
                .exit_code,
            0);
}

TEST_F(SynthTest, ARecordingAndARunKeepTheStampsOfTheirSource) {
  ASSERT_EQ(record(replaced(box_scene(), "type: synthetic",
                            "type: synthetic\n  faults: [{frames: [2, 3], kind: missing}]"))
                .exit_code,
            0);
  const std::string times =
      "frame,time\n0,1403636579.763555584\n1,1403636579.813555457\n2,1403636579.913555328\n";
  write_text(path("out/times.csv"), times);
  const Outcome again =
      run_program({"synth", path("out/scene.yaml").string(), "--out", path("again").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_text(path("again/times.csv")), times);
  const Outcome run = run_program({"run", path("again/scene.yaml").string(), "--out",
                                   path("run").string(), "--set", "output.also=[{type: tum}]"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = lines_of(read_text(path("run/track.csv")));
  EXPECT_THAT(rows[2], testing::AllOf(testing::StartsWith("1,0.049999873,"),
                                      testing::HasSubstr(",1403636579.813555457,")));
  EXPECT_THAT(read_text(path("run/box.tum")), testing::HasSubstr("1403636579.813555457 "));
}

TEST_F(SynthTest, ARecordingCanBeMoved) {
  ASSERT_EQ(record(box_scene(), {"--frames", "2"}).exit_code, 0);
  std::filesystem::rename(path("out"), path("moved"));
  const Outcome tracked =
      run_program({"run", path("moved/scene.yaml").string(), "--out", path("results").string()});
  EXPECT_EQ(tracked.exit_code, 0) << tracked.err;
}

TEST_F(SynthTest, AnExistingFolderIsRefusedUnlessItIsEmpty) {
  std::filesystem::create_directory(path("out"));
  EXPECT_EQ(record(box_scene(), {"--frames", "1"}).exit_code, 0);
  const auto before = names_in(path("out"));
  const Outcome again = record(box_scene(), {"--frames", "2"});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, testing::HasSubstr(path("out").string() + ": exists already"));
  EXPECT_EQ(names_in(path("out")), before);
}

TEST_F(SynthTest, AFileInItsPlaceIsLeftAlone) {
  write_text(path("out"), "");
  const Outcome outcome = record(box_scene(), {"--frames", "1"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, testing::HasSubstr("exists already"));
  EXPECT_TRUE(std::filesystem::is_regular_file(path("out")));
}

TEST_F(SynthTest, AFailureLeavesNothing) {
  Start start;
  start.arguments = {"synth", scene(box_scene()), "--out", path("out").string()};
  start.largest_file = 8192;  // less than a picture
  const Outcome outcome = run_program(start);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, testing::HasSubstr("the image cannot be written"));
  EXPECT_THAT(names_in(folder()), ElementsAre("scene.yaml"));
}

TEST_F(SynthTest, OneCameraIsARecordingTooAndARecordingCanBeRecorded) {
  const Outcome recorded =
      record(replaced(box_scene(), "focal_px: 160,", "focal_px: 160, count: 1,"));
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const auto names = names_in(path("out"));
  EXPECT_THAT(names, Contains("left_mask_000004.png"));
  EXPECT_THAT(names, testing::Not(Contains(testing::StartsWith("right"))));
  const Outcome again =
      run_program({"synth", path("out/scene.yaml").string(), "--out", path("again").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  ASSERT_EQ(names_in(path("again")), names);
  for (const std::string& name : names) {
    if (name.ends_with(".png") || name.starts_with("truth")) {
      EXPECT_EQ(read_text(path("again") / name), read_text(path("out") / name)) << name;
    }
  }
}

TEST_F(SynthTest, TrackingTheDepthOfARecordingIsTrackingTheDepthOfTheSource) {
  std::string text = replaced(box_scene(), "focal_px: 160,", "focal_px: 160, count: 1,");
  text = replaced(text, "  keyframes:", "  depth: true\n  keyframes:");
  text = replaced(text, "stereo_color", "rgbd_depth");
  ASSERT_EQ(record(text).exit_code, 0);
  EXPECT_THAT(names_in(path("out")), Contains("left_depth_000004.png"));
  const Outcome direct = run_program({"run", scene(text), "--out", path("direct").string()});
  ASSERT_EQ(direct.exit_code, 0) << direct.err;
  const Outcome tracked =
      run_program({"run", path("out/scene.yaml").string(), "--out", path("from_disk").string()});
  ASSERT_EQ(tracked.exit_code, 0) << tracked.err;
  EXPECT_EQ(track_without_times(path("from_disk")), track_without_times(path("direct")));
}

TEST_F(SynthTest, SourceYamlMakesTheSameRecording) {
  ASSERT_EQ(record(box_scene(), {"--frames", "2"}).exit_code, 0);
  const Outcome again = run_program({"synth", path("out/source.yaml").string(), "--out",
                                     path("again").string(), "--frames", "2"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const std::string& name : names_in(path("out"))) {
    EXPECT_EQ(read_text(path("again") / name), read_text(path("out") / name)) << name;
  }
}

TEST_F(SynthTest, WhatWasDrawnIsWhatErrorsAreMeasuredAgainst) {
  const std::string text =
      replaced(box_scene(), "  keyframes:",
               "  render_models: {box: {type: rigid_box, size_mm: [99, 66, 44]}}\n  keyframes:");
  ASSERT_EQ(record(text).exit_code, 0);
  ASSERT_EQ(run_program({"run", scene(text), "--out", path("direct").string()}).exit_code, 0);
  ASSERT_EQ(
      run_program({"run", path("out/scene.yaml").string(), "--out", path("from_disk").string()})
          .exit_code,
      0);
  ASSERT_EQ(run_program({"run", scene(box_scene()), "--out", path("plain").string()}).exit_code, 0);
  EXPECT_EQ(track_without_times(path("from_disk")), track_without_times(path("direct")));
  EXPECT_EQ(read_text(path("from_disk/errors.csv")), read_text(path("direct/errors.csv")));
  EXPECT_NE(read_text(path("plain/errors.csv")), read_text(path("direct/errors.csv")));
}

}  // namespace
}  // namespace hypotrack::test
