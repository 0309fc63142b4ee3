#include <nlohmann/json.hpp>
#include <opencv2/videoio.hpp>

#include "app_test.hpp"
#include "cost/cuda/device.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// A test with an objective whose device gets lost.
class LostDeviceTest : public AppTest {
 protected:
  static std::string lost_after(int frames) {
    return replaced(box_scene(), "{type: stereo_color}",
                    "{type: failing, frames: " + std::to_string(frames) + "}");
  }

  Outcome run_lost(const std::string& text) const {
    return run(text, {"--plugin-path", (build_dir() / "tests/plugin_fixtures/app").string(),
                      "--set", "recovery.enabled=false"});
  }
};

TEST_F(LostDeviceTest, TheFilesHoldTheFramesBefore) {
  const Outcome outcome = run_lost(replaced(lost_after(2), "{overlay: false}", "{overlay: true}"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("holds the frames so far"));
  EXPECT_THAT(names_in(path("out")),
              ElementsAre("errors.csv", "joints.csv", "metrics.json", "overlay.mp4", "run.yaml",
                          "summary.json", "track.csv", "truth_landmarks.csv", "truth_states.csv",
                          testing::MatchesRegex("worst_[01]\\.jpg")));
  for (const char* table : {"track.csv", "joints.csv", "errors.csv", "truth_states.csv"})
    EXPECT_THAT(lines_of(read_text(path("out") / table)), SizeIs(3)) << table;
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  EXPECT_EQ(summary.at("complete"), false);
  EXPECT_EQ(summary.at("frames"), 2);
  EXPECT_EQ(nlohmann::json::parse(read_text(path("out/metrics.json"))).at("frames"), 2);
  cv::VideoCapture video(path("out/overlay.mp4").string());
  cv::Mat picture;
  int pictures = 0;
  while (video.read(picture)) ++pictures;
  EXPECT_EQ(pictures, 2);
}

TEST_F(LostDeviceTest, TheReasonIsSaidOnce) {
  const Outcome outcome = run_lost(lost_after(2));
  const auto lines = lines_of(outcome.err);
  EXPECT_EQ(std::ranges::count_if(lines,
                                  [](const std::string& line) {
                                    return line.starts_with("hypotrack: frame 2: ") &&
                                           line.ends_with(": the device is lost");
                                  }),
            1)
      << outcome.err;
  const auto at = outcome.err.find("the device is lost");
  EXPECT_EQ(outcome.err.find("the device is lost", at + 1), std::string::npos) << outcome.err;
  EXPECT_THAT(outcome.err, testing::Not(HasSubstr("unexpected error")));
}

TEST_F(LostDeviceTest, TheNextRunTakesTheResultsPlace) {
  ASSERT_EQ(run_lost(lost_after(2)).exit_code, 1);
  const Outcome outcome = run_lost(lost_after(5));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(6));
}

TEST_F(LostDeviceTest, TheRunGoesOnWithTheCpuIfAskedTo) {
  // The objective's device works again after one failure.
  const std::string once = replaced(lost_after(2), "frames: 2", "frames: 2, failures: 1");
  const Outcome outcome = run_lost(once + "evaluate: {on_device_loss: cpu}\n");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto lines = lines_of(outcome.err);
  EXPECT_EQ(std::ranges::count_if(lines,
                                  [](const std::string& line) {
                                    return line.starts_with("note: frame 2: ") &&
                                           line.ends_with(
                                               "the device is lost; the run goes on "
                                               "with the CPU");
                                  }),
            1)
      << outcome.err;
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(6));
  const auto summary = nlohmann::json::parse(read_text(path("out/summary.json")));
  EXPECT_EQ(summary.at("complete"), true);
  EXPECT_THAT(summary.at("backend").get<std::string>(),
              AllOf(HasSubstr(", then the CPU after: "), HasSubstr("the device is lost")));
}

TEST_F(LostDeviceTest, LostOnTheFirstFrameItLeavesNothing) {
  expect_refusal(run_lost(lost_after(0)), {"the device is lost"});
}

/// A test with a scene that asks for a GPU on a machine without one.
class NoDeviceTest : public AppTest {
 protected:
  void SetUp() override {
    why_ = cuda::why_no_device();
    if (why_.empty()) GTEST_SKIP() << "needs a machine without a GPU";
  }

  static std::string scene_for_cuda() { return box_scene() + "evaluate: {backend: cuda}\n"; }

  /// The message says what is missing and what to write instead.
  std::vector<std::string> message() const {
    return {"evaluate.backend: cuda: " + why_, "Write `backend: cpu`"};
  }

 private:
  std::string why_;
};

TEST_F(NoDeviceTest, ARunSaysWhatIsMissingAndWhatToWrite) {
  expect_refused(scene_for_cuda(), message());
}

TEST_F(NoDeviceTest, SoDoesValidate) {
  expect_refusal(run_program({"validate", scene(scene_for_cuda())}), message());
}

TEST_F(NoDeviceTest, AnOptimizerThatNeedsOneIsRefusedByValidateAsByARun) {
  for (const char* optimizer :
       {"{type: pso_cuda}", "{type: pipeline, stages: [{optimizer: {type: pso_cuda}}]}",
        "{type: limb_search, optimizer: {type: multi_start, optimizer: {type: pso_cuda}}}"}) {
    const std::string text =
        replaced(box_scene(), "{type: pso, particles: 8, generations: 4}", optimizer);
    const Outcome tracked = run(text);
    expect_refusal(tracked, {"scene.yaml:9:", "pso_cuda", "Write", "`type: pso`"});
    const Outcome looked_at = run_program({"validate", scene(text)});
    expect_refusal(looked_at, {});
    EXPECT_EQ(looked_at.err, tracked.err);
  }
}

TEST_F(NoDeviceTest, AutomaticTakesTheCpuAndSaysWhy) {
  const Outcome outcome = run(box_scene() + "evaluate: {backend: auto}\n");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("tracking with cpu ("),
                                 HasSubstr("not on a GPU: " + cuda::why_no_device())));
}

}  // namespace
}  // namespace hypotrack::test
