#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Fits to a box that moves at random.
class FitJudgeTest : public AppTest {
 protected:
  std::string moving_box() const {
    return scene(R"(models: [{name: box, type: rigid_box, size_mm: [90, 60, 40]}]
source:
  type: synthetic
  cameras: {width: 160, height: 120, focal_px: 160, baseline_mm: 80}
  random: {frames: 16, rotation: any, lowest_mm: [-40, -20, 380], highest_mm: [40, 20, 440]}
objective: {type: stereo_color}
optimizer: {type: levenberg_marquardt}
budget: {evaluations: 60}
tile: {size: 32}
init: {from: truth}
output: {overlay: false}
)");
  }
  Outcome fit(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"fit-judge", moving_box(), "--out",
                                       path("weights.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
};

TEST_F(FitJudgeTest, WritesWeightsThatARunTakes) {
  const Outcome fitted = fit({"--sequences", "5", "--frames", "16"});
  EXPECT_EQ(fitted.exit_code, 0) << fitted.err;
  EXPECT_THAT(fitted.out, AllOf(HasSubstr("5 sequences of scene.yaml: "),
                                HasSubstr("Poses of held-out sequences above tracked_above"),
                                HasSubstr("right, up to 10 mm"), HasSubstr("wrong, over 20 mm")));
  EXPECT_THAT(read_text(path("weights.yaml")),
              AllOf(HasSubstr("version: 1\n"), HasSubstr("fitted_to: [rigid_box]\n")));
  const Outcome tracked =
      run_program({"run", path("scene.yaml").string(), "--out", path("out").string(), "--set",
                   "judge={type: network, weights: " + path("weights.yaml").string() + "}"});
  EXPECT_EQ(tracked.exit_code, 0) << tracked.err;
  EXPECT_THAT(read_text(path("out/run.yaml")), HasSubstr("weights.yaml\n"));
}

TEST_F(FitJudgeTest, ASequenceThatIsTooShortIsRefused) {
  const Outcome outcome = fit({"--sequences", "1", "--frames", "2"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("judge 'network'"), HasSubstr("expected 100 of each"),
                                 HasSubstr("give more frames or sequences")));
}

TEST_F(FitJudgeTest, ASceneWithoutAJudgeIsRefused) {
  const Outcome outcome = fit({"--set", "judge=none", "--sequences", "1", "--frames", "2"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("found `judge: none`"), HasSubstr("--set judge=network")));
}

TEST_F(FitJudgeTest, AJudgeWithNothingToFitIsRefusedBeforeAnyFrame) {
  const Outcome outcome = fit({"--judge", "agreement"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("judge 'agreement'"), HasSubstr("nothing to fit")));
}

TEST_F(FitJudgeTest, ErrorsThatExcludeEachOtherAreRefused) {
  const Outcome outcome = fit({"--right-mm", "30"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("--wrong-mm is 20, less than --right-mm, which is 30"));
}

}  // namespace
}  // namespace hypotrack::test
