#include <nlohmann/json.hpp>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

/// A recording of five frames and the scene that tracks it.
class BadRecordingTest : public AppTest {
 protected:
  void SetUp() override {
    const Outcome outcome =
        run_program({"synth", scene(box_scene()), "--out", path("recording").string()});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  std::filesystem::path recorded(const std::string& name) const { return path("recording") / name; }
  Outcome track(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"run", recorded("scene.yaml").string(), "--out",
                                       path("out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  /// Replaces a piece of the calibration.
  void calibrate(const std::string& piece, const std::string& by) const {
    const auto file = recorded("calibration.yaml");
    write_text(file, replaced(read_text(file), piece, by));
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(read_text(path("out/summary.json")));
  }
};

TEST_F(BadRecordingTest, ADamagedImageIsAMissingFrameAndTheRunGoesOn) {
  write_text(recorded("right_000002.png"), "no picture");
  const Outcome outcome = track();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("frame 2: " + recorded("right_000002.png").string()));
  EXPECT_THAT(outcome.out, HasSubstr("1 missing"));
  const auto track_lines = lines_of(read_text(path("out/track.csv")));
  ASSERT_THAT(track_lines, SizeIs(6));
  EXPECT_THAT(track_lines[3], HasSubstr(",missing,nan,0,"));
  EXPECT_THAT(track_lines[4], Not(HasSubstr("missing")));
  EXPECT_EQ(summary().at("missing_frames"), 1);
  EXPECT_EQ(summary().at("complete"), true);
  // Its truth is known, but there is no solution that could be wrong.
  EXPECT_EQ(lines_of(read_text(path("out/errors.csv")))[3].substr(0, 2), "2,");
  EXPECT_THAT(lines_of(read_text(path("out/errors.csv")))[3], testing::EndsWith(",nan,nan"));
  const auto metrics = nlohmann::json::parse(read_text(path("out/metrics.json")));
  EXPECT_EQ(metrics.at("frames"), 5);
  EXPECT_EQ(metrics.at("missing_frames"), 1);
  EXPECT_EQ(metrics.at("evaluated_frames"), 4);
  EXPECT_EQ(run_program({"evaluate", path("out").string()}).exit_code, 0);
}

TEST_F(BadRecordingTest, ACalibrationOfOtherCamerasIsNotTrackedBesideTheMasks) {
  calibrate("T: [-0.08,", "T: [0.08,");
  const auto note =
      testing::AllOf(HasSubstr("note: no point of the models at the start is on the foreground of "
                               "all masks, and such a frame counts as uncertain"),
                     HasSubstr("calibration"));
  // The pictures alone say that the cameras are exchanged.
  const std::string unchecked = "status.check_pictures=false";
  const Outcome outcome = track({"--set", "judge=none", "--set", unchecked});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, note);
  EXPECT_THAT(outcome.out,
              HasSubstr("5 frames (0 tracked, 5 uncertain, 0 lost, 0 absent, 0 missing)"));
  EXPECT_THAT(run_program({"validate", recorded("scene.yaml").string()}).err, note);
  EXPECT_THAT(track({"--set", "judge=none", "--set", unchecked, "--set", "status.patience=3"}).out,
              HasSubstr("(0 tracked, 2 uncertain, 3 lost"));
}

TEST_F(BadRecordingTest, ARunDoesNotReplaceTheAnswerOfItsRecording) {
  const std::string truth = read_text(recorded("truth_landmarks.csv"));
  const Outcome outcome = run_program({"run", recorded("scene.yaml").string(), "--frames", "2",
                                       "--out", path("recording").string()});
  expect_refusal(outcome, {path("recording/truth_").string(), "not of a run", "--out"});
  EXPECT_EQ(read_text(recorded("truth_landmarks.csv")), truth);
}

TEST_F(BadRecordingTest, ASecondCameraToTheLeftIsPointedOut) {
  EXPECT_THAT(track().err, Not(HasSubstr("note:")));
  calibrate("T: [-0.08,", "T: [0.08,");
  const auto note = HasSubstr("note: the second camera stands 80 mm to the left of the first");
  EXPECT_THAT(track().err, note);
  EXPECT_THAT(run_program({"validate", recorded("scene.yaml").string()}).err, note);
}

TEST_F(BadRecordingTest, ATruthOfOtherFramesIsRefused) {
  const std::string table = recorded("truth_landmarks.csv").string();
  const Outcome outcome = track({"--set", "source.truth_offset=100"});
  expect_refusal(outcome, {table, "has frames 0 to 4", "frames, 100 to 104; set truth_offset"});
  expect_refusal(run_program({"validate", recorded("scene.yaml").string(), "--set",
                              "source.truth_offset=100"}),
                 {table});
}

TEST_F(BadRecordingTest, DamageBeforeTheFirstUsableFrameCountsAsFrames) {
  write_text(recorded("left_000000.png"), "no picture");
  const std::vector<std::string> rest{
      "--set", "init={from: file, file: " + recorded("truth_states.csv").string() + "}"};
  std::vector<std::string> two = rest;
  two.insert(two.end(), {"--frames", "2"});
  ASSERT_EQ(track(two).exit_code, 0);
  EXPECT_EQ(summary().at("frames"), 2);
  EXPECT_EQ(summary().at("missing_frames"), 1);
  const auto track_lines = lines_of(read_text(path("out/track.csv")));
  EXPECT_THAT(track_lines[1], HasSubstr("0,0,missing,nan"));
  EXPECT_THAT(track_lines[2], Not(HasSubstr("missing")));
}

TEST_F(BadRecordingTest, NoUsableFrameAmongThoseAskedFor) {
  write_text(recorded("left_000000.png"), "no picture");
  write_text(recorded("left_000001.png"), "no picture");
  expect_refusal(track({"--frames", "2"}),
                 {"none of the source's 2 frames can be used", "left_000000.png"});
}

TEST_F(BadRecordingTest, NoUsableFrameAtAll) {
  for (int i = 0; i < 5; ++i)
    write_text(recorded("left_00000" + std::to_string(i) + ".png"), "no picture");
  expect_refusal(track(), {"no image can be read", "left_000000.png"});
}

TEST_F(BadRecordingTest, MissingImages) {
  expect_refusal(track({"--set", "source.left=" + path("none_%06d.png").string()}),
                 {"none_000000.png: is missing"});
}

TEST_F(BadRecordingTest, ImagesOfUnequalSizes) {
  const std::string large = replaced(box_scene(), "width: 160, height: 120",
                                     "width: 200, height: "
                                     "150");
  ASSERT_EQ(run_program({"synth", scene(large, "large.yaml"), "--out", path("large").string(),
                         "--frames", "2"})
                .exit_code,
            0);
  std::filesystem::copy_file(path("large/right_000001.png"), recorded("right_000001.png"),
                             std::filesystem::copy_options::overwrite_existing);
  const Outcome outcome = track();
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("right_000001.png: is 200x150 pixels; expected 160x120"));
  EXPECT_EQ(summary().at("missing_frames"), 1);
}

TEST_F(BadRecordingTest, ImagesOfAnotherSizeThanTheirCalibration) {
  calibrate("image_width: 160", "image_width: 320");
  expect_refusal(track(), {"left_000000.png", "160x120", "320x120", "resolution"});
}

TEST_F(BadRecordingTest, CalibrationWithNan) {
  calibrate("K: [160,", "K: [.nan,");
  expect_refusal(track(), {"calibration.yaml", "nan"});
}

TEST_F(BadRecordingTest, CalibrationWhoseRotationIsNone) {
  calibrate("R: [1, 0, 0,", "R: [1.2, 0, 0,");
  expect_refusal(track(), {"calibration.yaml", "R"});
}

TEST_F(BadRecordingTest, BaselineOfMillimetresReadAsMetres) {
  calibrate("T: [-0.08,", "T: [-80,");
  expect_refusal(track(), {"calibration.yaml", "80 m", "millimetres"});
}

TEST_F(BadRecordingTest, StartFromATruthThatIsNotThere) {
  const auto file = recorded("scene.yaml");
  std::string text = read_text(file);
  for (const char* key : {"  truth_states", "  truth_landmarks"}) {
    const auto at = text.find(key);
    ASSERT_NE(at, std::string::npos);
    text.erase(at, text.find('\n', at) + 1 - at);
  }
  write_text(file, text);
  expect_refusal(track(), {"init.from is 'truth'", "init.pose or init.file"});
}

TEST_F(BadRecordingTest, WithoutTruthThereAreNoErrors) {
  const auto file = recorded("scene.yaml");
  std::string text = read_text(file);
  for (const char* key : {"  truth_states", "  truth_landmarks"}) {
    const auto at = text.find(key);
    text.erase(at, text.find('\n', at) + 1 - at);
  }
  write_text(file, text);
  const Outcome outcome = track({"--set",
                                 "init={from: rest, pose: {box: {position_mm: [0, 0, "
                                 "400]}}}"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, Not(HasSubstr("joint error")));
  EXPECT_THAT(names_in(path("out")),
              testing::ElementsAre("joints.csv", "run.yaml", "summary.json", "track.csv"));
  EXPECT_FALSE(summary().contains("mean_joint_error_mm"));
}

}  // namespace
}  // namespace hypotrack::test
