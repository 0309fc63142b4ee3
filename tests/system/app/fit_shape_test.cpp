#include <algorithm>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

/// A hand that bends its fingers in small pictures, drawn 6 % larger than the tracked one and with
/// an index finger 4 % longer.
const char* const kHand = R"(
models: [{name: hand, type: hand}]
source:
  type: synthetic
  frames: 8
  cameras: {width: 160, height: 120, focal_px: 150, baseline_mm: 60}
  gestures: {bent: {"*_flexion_?": 40}}
  render_models: {hand: {type: hand, shape: {scale: 1.06, index: 1.04}}}
  keyframes:
    - {frame: 0, pose: {hand: {position_mm: [0, 80, 450], rotation_deg: [180, 0, 0]}}}
    - {frame: 7, gesture: bent, pose: {hand: {position_mm: [10, 70, 450], rotation_deg: [170, 20, 0]}}}
objective: {type: stereo_color}
optimizer: {type: pso, particles: 8, generations: 4}
evaluate: {backend: cpu}
output: {overlay: false, worst_frames: 0}
init: {from: truth}
)";

class FitShapeTest : public AppTest {
 protected:
  Outcome fit(const std::string& text, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"fit-shape", scene(text), "--out", path("out").string()});
    return run_program(more);
  }
};

TEST_F(FitShapeTest, FromTruthFindsWhatTheLabelsHaveAndRunTakesIt) {
  const Outcome outcome =
      fit(kHand, {"--from", "truth", "--set", "shape.parameters=[scale, index]"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string file = read_text(path("out"));
  EXPECT_THAT(file, testing::ContainsRegex("\nscale: 1\\.0(59|60|61)"));
  // What is known beforehand draws it towards 1 by a tenth of the way.
  EXPECT_THAT(file, testing::ContainsRegex("\nindex: 1\\.(03[5-9]|04[0-5])"));
  EXPECT_THAT(file, HasSubstr("\nring: 1.0000\n"));
  const Outcome tracked =
      run_program({"run", path("scene.yaml").string(), "--out", path("tracked").string(),
                   "--frames", "1", "--set", "models.0.shape_file=" + path("out").string()});
  EXPECT_EQ(tracked.exit_code, 0) << tracked.err;
}

TEST_F(FitShapeTest, WarnsOfWhatEndsAtABoundAndOfNothingElse) {
  const Outcome usual = fit(kHand, {"--from", "truth"});
  ASSERT_EQ(usual.exit_code, 0) << usual.err;
  EXPECT_THAT(usual.out, HasSubstr("8 of 8 labelled frames, mean distance "));
  EXPECT_THAT(usual.err, testing::Not(HasSubstr("bound")));
  const Outcome large = fit(replaced(kHand, "shape: {scale: 1.06, index: 1.04}", "scale: 1.5"),
                            {"--from", "truth", "--set", "shape.parameters=[scale]"});
  ASSERT_EQ(large.exit_code, 0) << large.err;
  const std::string warning = "scale ends at 1.3500, its upper bound being 1.35: nobody is built";
  EXPECT_THAT(large.err, HasSubstr("hypotrack: warning: " + warning));
  EXPECT_THAT(read_text(path("out")), HasSubstr("\n# " + warning));
}

TEST_F(FitShapeTest, LeavesOutFramesWhoseLandmarksAreUnknown) {
  const Outcome outcome =
      fit(kHand, {"--from", "truth", "--set", "source.faults=[{frames: [0, 1], kind: absent}]",
                  "--set", "shape.parameters=[scale]"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("6 of 6 labelled frames, mean distance "));
}

TEST_F(FitShapeTest, TracksAndFitsInRoundsAndSaysWhatItFinds) {
  const Outcome outcome =
      fit(kHand, {"--frames", "4", "--set", "shape={rounds: 1, frames: 4, iterations: 2}"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("round 1 of 1: "));
  for (const char* name : {"scale", "thumb", "little", "width"}) {
    EXPECT_THAT(outcome.out, HasSubstr(std::string("\n") + name + " "));
    EXPECT_THAT(read_text(path("out")), HasSubstr(std::string("\n") + name + ": "));
  }
}

TEST_F(FitShapeTest, ARunThatEstimatesTracksAllFramesAndCanBeRepeated) {
  const Outcome outcome =
      run(kHand, {"--set", "shape={estimate_s: 0.1, rounds: 1, frames: 3, iterations: 1}"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("fitting the shape to the first 0.1 s, round 1 of 1"));
  EXPECT_THAT(outcome.err, HasSubstr("shape from 3 frames, scale "));
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), testing::SizeIs(9));
  const Outcome again =
      run_program({"run", path("out/run.yaml").string(), "--out", path("again").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(track_without_times(path("again")), track_without_times(path("out")));
}

TEST_F(FitShapeTest, PicturesAndTruthDoNotFollowTheShapeThatARunFinds) {
  const std::string as_tracked = replaced(
      kHand, "  render_models: {hand: {type: hand, shape: {scale: 1.06, index: 1.04}}}\n", "");
  const std::string shape = "shape={estimate_s: 0.1, rounds: 1, frames: 3, iterations: 1}";
  ASSERT_EQ(run(as_tracked, {"--set", shape}).exit_code, 0);
  const Outcome plain = run_program(
      {"run", path("scene.yaml").string(), "--out", path("plain").string(), "--frames", "8"});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(read_text(path("out/truth_landmarks.csv")),
            read_text(path("plain/truth_landmarks.csv")));
  const Outcome again =
      run_program({"run", path("out/run.yaml").string(), "--out", path("again").string()});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(track_without_times(path("again")), track_without_times(path("out")));
  EXPECT_EQ(read_text(path("again/errors.csv")), read_text(path("out/errors.csv")));
}

TEST_F(FitShapeTest, APlaceWhereNothingCanBeWrittenIsFoundBeforeTheWork) {
  std::filesystem::create_directory(path("folder"));
  expect_refusal(run_program({"fit-shape", scene(kHand), "--out", path("folder").string()}),
                 {path("folder").string() + ": is a folder", "--out"});
  expect_refusal(run_program({"fit-shape", scene(kHand), "--out", path("none/s.yaml").string()}),
                 {path("none/s.yaml").string(), "check that the folder exists", "--out"});
}

TEST_F(FitShapeTest, RefusesAModelWithoutAShape) {
  expect_refusal(fit(box_scene()), {"no model of this scene has shape parameters"});
}

TEST_F(FitShapeTest, RefusesAnObjectiveWithoutResiduals) {
  expect_refusal(fit(replaced(kHand, "{type: stereo_color}",
                              "{type: stereo_color, aggregation: sum_per_sqrt}")),
                 {"objective stereo_color", "offers no residuals, which fitting a shape needs"});
}

TEST_F(FitShapeTest, RefusesASourceOfOneFrame) {
  expect_refusal(fit(replaced(kHand, "frames: 8", "frames: 1")),
                 {"1 of 1 frames were tracked, expected at least 2"});
}

TEST_F(FitShapeTest, RefusesFramesInWhichTheModelIsElsewhere) {
  // Beside the hand, covering a pixel costs more than it explains; one evaluation does not move it.
  expect_refusal(
      fit(kHand, {"--set", "objective={type: skin, foreground: mask}", "--set", "init.away_mm=120",
                  "--set", "budget.evaluations=1", "--set", "judge=none"}),
      {"shape: in most of the 8 tracked frames", "look at the overlay of a run"});
}

TEST_F(FitShapeTest, RefusesAnObjectiveThatLooksAtNoPictures) {
  expect_refusal(fit(kHand, {"--set", "objective={type: plausible_motion}"}),
                 {"shape: in most of the 8 tracked frames"});
}

TEST_F(FitShapeTest, FromStartersNeedsOneThatDetectsAndTheScale) {
  const Outcome no_start = run(kHand, {"--set", "shape={estimate_s: 0.1, from: starters}"});
  EXPECT_NE(no_start.exit_code, 0);
  EXPECT_THAT(no_start.err, HasSubstr("no starter detects the models"));
  const Outcome no_scale =
      run(kHand, {"--set", "init={from: global_search}", "--set",
                  "shape={estimate_s: 0.1, from: starters, parameters: [index]}"});
  EXPECT_NE(no_scale.exit_code, 0);
  EXPECT_THAT(no_scale.err, HasSubstr("starters tell the scale alone"));
}

}  // namespace
}  // namespace hypotrack::test
