#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "app_test.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/media.hpp"
#include "new_scene/scene_request.hpp"

namespace hypotrack::test {
namespace {

using app::RecordingFiles;
using testing::AllOf;
using testing::HasSubstr;

/// A recording of two frames in the folder `recording`.
class NewSceneTest : public AppTest {
 protected:
  void SetUp() override {
    const Outcome outcome = run_program(
        {"synth", scene(box_scene()), "--out", path("recording").string(), "--frames", "2"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  std::string recording() const { return path("recording").string(); }
  std::string file() const { return path("new.yaml").string(); }

  Outcome new_scene(const std::vector<std::string>& options) const {
    std::vector<std::string> arguments{"new", "scene", file()};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_program(arguments);
  }

  /// Expects one message, exit code 1, and that nothing was written.
  void expect_nothing_new(const Outcome& outcome, const std::vector<std::string>& pieces) const {
    expect_refusal(outcome, pieces);
    EXPECT_THAT(names_in(folder()), testing::ElementsAre("recording", "scene.yaml"));
  }

  /// Writes the recording's pictures as a video, of one view or of both side by side, or of both
  /// one above the other.
  std::string video(const std::string& name, const std::vector<std::string>& views,
                    bool above = false) const {
    cv::VideoWriter writer;
    for (const std::string frame : {"_000000.png", "_000001.png"}) {
      std::vector<cv::Mat> pictures;
      for (const std::string& view : views)
        pictures.push_back(read_image(path("recording/" + view + frame).string()));
      cv::Mat all;
      if (above)
        cv::vconcat(pictures, all);
      else
        cv::hconcat(pictures, all);
      if (!writer.isOpened())
        writer.open(path(name).string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 30,
                    all.size());
      writer.write(all);
    }
    return path(name).string();
  }
};

TEST_F(NewSceneTest, TheSceneValidatesAndTheNextCommandsArePrinted) {
  const Outcome outcome =
      new_scene({"--recording", recording(), "--model", "hand", "--tracker", "real_time"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("1 model, 27 parameters, 2 frames"),
                                 HasSubstr("hypotrack validate " + file()),
                                 HasSubstr("hypotrack run " + file())));
  EXPECT_THAT(read_text(file()), AllOf(HasSubstr("left: \"recording/left_%06d.png\""),
                                       HasSubstr("from: auto"), HasSubstr("@trackers/real_time")));
  const Outcome validated = run_program({"validate", file()});
  EXPECT_EQ(validated.exit_code, 0) << validated.err;
  EXPECT_THAT(names_in(folder()), testing::ElementsAre("new.yaml", "recording", "scene.yaml"));
}

TEST_F(NewSceneTest, EveryModelHasATracker) {
  const auto text_of = [&](const std::vector<std::string>& model) {
    std::vector<std::string> options{"--recording", recording(), "--tracker", "recommended",
                                     "--force"};
    options.insert(options.end(), model.begin(), model.end());
    const Outcome outcome = new_scene(options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return read_text(file());
  };
  EXPECT_THAT(text_of({"--model", "left_hand"}), HasSubstr("type: mirrored_hand"));
  EXPECT_THAT(text_of({"--model", "two_hands"}),
              AllOf(HasSubstr("type: hand"), HasSubstr("type: mirrored_hand"),
                    HasSubstr("@trackers/two_hands")));
  EXPECT_THAT(text_of({"--model", "hand_and_box", "--box", "6x12x3cm"}),
              AllOf(HasSubstr("size_mm: [60, 120, 30]"), HasSubstr("@trackers/recommended")));
  EXPECT_THAT(text_of({"--model", "box", "--box", "60x120x30mm"}),
              AllOf(HasSubstr("size_mm: [60, 120, 30]"), Not(HasSubstr("hand"))));
}

TEST_F(NewSceneTest, CamerasOfTheCalibrationAreChosenByName) {
  const std::vector<std::string> options{"--recording", recording(), "--model",   "hand",
                                         "--tracker",   "real_time", "--cameras", "0,1"};
  const Outcome outcome = new_scene(options);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(read_text(file()), HasSubstr("cameras: [\"0\", \"1\"]"));
}

TEST(SceneText, HasTheSettingsOfLiveCameras) {
  app::SceneRequest request;
  request.recording.live = {.device = "0",
                            .left = {},
                            .right = {},
                            .size = "2560x720",
                            .fps = "60",
                            .pixel_format = "MJPG"};
  request.recording.calibration = "calibration.yaml";
  request.model = "hand";
  request.tracker = "real";
  EXPECT_THAT(app::scene_text(request, ""),
              AllOf(HasSubstr("device: \"0\""), HasSubstr("width: 2560"), HasSubstr("height: 720"),
                    HasSubstr("fps: 60"), HasSubstr("pixel_format: MJPG"),
                    HasSubstr("tracker: \"@trackers/real\"\nrecovery:\n  run: background\n"),
                    testing::Not(HasSubstr("estimate_s"))));
}

TEST_F(NewSceneTest, NamesOfCamerasMayHaveQuotes) {
  expect_nothing_new(new_scene({"--recording", recording(), "--model", "hand", "--tracker",
                                "real_time", "--cameras", "my \"left\",0"}),
                     {"my \"left\"", "expected"});
}

TEST_F(NewSceneTest, VideosAreTakenAsTwoOrSideBySide) {
  const std::string calibration = path("recording/calibration.yaml").string();
  const std::vector<std::string> rest{"--calibration", calibration, "--model", "hand",
                                      "--tracker",     "real_time", "--force"};
  const auto made_from = [&](std::vector<std::string> options) {
    options.insert(options.end(), rest.begin(), rest.end());
    const Outcome outcome = new_scene(options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return read_text(file());
  };
  const std::string left = video("a.avi", {"left"}), right = video("b.avi", {"right"});
  const auto is_pair =
      AllOf(HasSubstr("type: video"), HasSubstr("left: a.avi"), HasSubstr("right: b.avi"));
  EXPECT_THAT(made_from({"--recording", left, "--recording", right}), is_pair);
  EXPECT_THAT(made_from({"--left", left, "--right", right}), is_pair);
  EXPECT_THAT(made_from({"--recording", video("both.avi", {"left", "right"})}),
              HasSubstr("side_by_side: both.avi"));
  const std::string above = video("above.avi", {"left", "right"}, true);
  for (const char* option : {"--recording", "--left"})
    EXPECT_THAT(made_from({option, above, "--layout", "top_bottom"}),
                AllOf(HasSubstr("left: above.avi"), HasSubstr("layout: top_bottom"),
                      testing::Not(HasSubstr("right:"))));
  expect_refusal(new_scene({"--left", left, "--right", right, "--layout", "top_bottom", "--force"}),
                 {"--layout says how one picture holds both views"});
}

TEST_F(NewSceneTest, PicturesOfAnotherSizeThanTheCalibrationsAreRefused) {
  const std::string calibration = path("recording/calibration.yaml").string();
  std::string text = read_text(calibration);
  text = replaced(text, "image_width: 160", "image_width: 320");
  write_text(calibration, text);
  expect_nothing_new(
      new_scene({"--recording", recording(), "--model", "hand", "--tracker", "real_time"}),
      {"160x120", "320x120", "new.yaml was not written"});
}

TEST_F(NewSceneTest, ADamagedFirstPairIsRefused) {
  write_text(path("recording/left_000000.png"), "no picture");
  expect_nothing_new(
      new_scene({"--recording", recording(), "--model", "hand", "--tracker", "real_time"}),
      {"the first pair cannot be used", "left_000000.png"});
}

TEST_F(NewSceneTest, WithoutTheHandDetectorTheRealTrackerIsRefused) {
  Start start;
  start.arguments = {"new",     "scene", file(),      "--recording", recording(),
                     "--model", "hand",  "--tracker", "real"};
  start.environment = {"HYPOTRACK_HAND_DETECTOR=" + path("none").string()};
  expect_nothing_new(run_program(start), {"run `hypotrack get detector`"});
}

TEST_F(NewSceneTest, AFileThatIsThereIsKeptUnlessForced) {
  const std::vector<std::string> options{"--recording", recording(), "--model",
                                         "hand",        "--tracker", "real_time"};
  write_text(file(), "mine");
  expect_refusal(new_scene(options), {"new.yaml: is there already", "--force"});
  EXPECT_EQ(read_text(file()), "mine");
  std::vector<std::string> forced = options;
  forced.emplace_back("--force");
  EXPECT_EQ(new_scene(forced).exit_code, 0);
  EXPECT_THAT(read_text(file()), HasSubstr("models:"));
}

TEST_F(NewSceneTest, WithoutATerminalTheMissingOptionIsNamed) {
  const std::string no_terminal = "standard input is no terminal";
  expect_nothing_new(new_scene({}), {"--recording is not given", no_terminal});
  expect_nothing_new(new_scene({"--recording", recording()}),
                     {"--model is not given", no_terminal, "hand_and_box"});
  expect_nothing_new(new_scene({"--recording", recording(), "--model", "hand"}),
                     {"--tracker is not given", no_terminal});
  expect_nothing_new(new_scene({"--recording", recording(), "--model", "hand_and_box"}),
                     {"--box is not given", no_terminal});
  std::filesystem::rename(path("recording/calibration.yaml"), path("recording/cameras.yaml"));
  expect_nothing_new(new_scene({"--recording", recording()}),
                     {"--calibration is not given", no_terminal});
}

TEST_F(NewSceneTest, MistakesSayWhatIsExpected) {
  const std::vector<std::string> from{"--recording", recording()};
  const auto with = [&](std::vector<std::string> options) {
    options.insert(options.begin(), from.begin(), from.end());
    return new_scene(options);
  };
  for (const char* box : {"60x120", "60x120x30in", "0x1x2mm", "axbxc", "60x120x30x1"})
    expect_nothing_new(with({"--model", "hand_and_box", "--box", box}),
                       {std::string("--box: found '") + box, "60x120x30mm"});
  expect_nothing_new(with({"--model", "hand", "--box", "60x120x30mm"}),
                     {"expected --model hand_and_box or box"});
  expect_nothing_new(with({"--model", "hand", "--tracker", "rigid"}),
                     {"--tracker rigid tracks rigid objects, found --model hand", "real"});
  expect_nothing_new(with({"--model", "box", "--box", "60x120x30mm", "--tracker", "real"}),
                     {"--tracker real tracks hands, found --model box", "rigid or recommended"});
  expect_nothing_new(with({"--model", "two_hands", "--tracker", "real_time"}),
                     {"--tracker real_time tracks one hand", "real or recommended"});
  expect_nothing_new(new_scene({"--recording", path("none").string()}),
                     {"there is no such file or folder"});
  expect_nothing_new(new_scene({"--left", "left_%04d.png"}), {"--right is not given"});
  EXPECT_EQ(with({"--model", "foot"}).exit_code, 2);
  expect_nothing_new(run_program({"new", "scene", path("none/new.yaml").string()}),
                     {"none: there is no such folder for new.yaml"});
}

TEST_F(NewSceneTest, ATerminalIsAskedForWhatIsNotGiven) {
  if (!std::filesystem::exists("/usr/bin/script"))
    GTEST_SKIP() << "needs /usr/bin/script (Debian: bsdutils) for a terminal";
  const std::string program = (build_dir() / "bin/hypotrack").string();
  const std::string command = "printf '%s\\n' " + path("none").string() + " " + recording() +
                              " hnd hand real_time | " + "script -qec '" + program + " new scene " +
                              file() + "' /dev/null";
  const Captured captured = capture_output({"/bin/sh", {"-c", command}}, {1, 2});
  EXPECT_EQ(captured.end.code, 0) << captured.output;
  EXPECT_THAT(
      captured.output,
      AllOf(HasSubstr("none: there is no such file or folder"),
            HasSubstr("what to track (hand, left_hand, two_hands, hand_and_box, box) [hand]: "),
            HasSubstr("found 'hnd'"), HasSubstr("which tracker")));
  EXPECT_THAT(read_text(file()), HasSubstr("@trackers/real_time"));
}

TEST_F(NewSceneTest, TheRealPairOfABenchmarkIsTaken) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const Outcome outcome =
      new_scene({"--recording", (shared_data() / "stereo/stb").string(), "--calibration",
                 (source_dir() / "configs/cameras/stb.yaml").string(), "--model", "left_hand",
                 "--tracker", "recommended"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(read_text(file()), HasSubstr("BB_left_%d.png"));
}

/// Files of recordings, empty ones, in many layouts.
class FindRecordingTest : public AppTest {
 protected:
  RecordingFiles found(const std::vector<std::string>& names) const {
    const std::filesystem::path recording = path("100%");
    std::filesystem::remove_all(recording);
    for (const std::string& name : names) {
      std::filesystem::create_directories((recording / name).parent_path());
      write_text(recording / name, "");
    }
    return app::find_recording(recording);
  }
  std::string in_pattern(const std::string& name) const { return (path("100%%") / name).string(); }
};

TEST_F(FindRecordingTest, PicturesBecomePatterns) {
  const RecordingFiles padded = found({"left_0009.png", "left_0010.png", "right_0009.png",
                                       "left_mask_0009.png", "right_depth_0009.png"});
  EXPECT_EQ(padded.left, in_pattern("left_%04d.png"));
  EXPECT_EQ(padded.right, in_pattern("right_%04d.png"));
  EXPECT_EQ(found({"BB_left_0.png", "BB_left_10.png", "BB_right_0.png"}).left,
            in_pattern("BB_left_%d.png"));
  EXPECT_EQ(found({"left/left1.jpg", "right/right1.jpg"}).right, in_pattern("right/right%d.jpg"));
  EXPECT_EQ(found({"mav0/cam0/1403636579763555584.png", "mav0/cam1/1403636579763555584.png"}).left,
            in_pattern("mav0/cam0/*.png"));
  EXPECT_EQ(found({"left.png", "right.png"}).left, in_pattern("left.png"));
}

TEST_F(FindRecordingTest, VideosAreTakenByTheirNames) {
  const RecordingFiles files = found({"cam0_test.mp4", "cam1_test.mp4", "cam10_test.mp4"});
  EXPECT_EQ(files.left, path("100%/cam0_test.mp4"));
  EXPECT_EQ(files.right, path("100%/cam1_test.mp4"));
}

TEST_F(FindRecordingTest, TheCalibrationBesideThePicturesIsTaken) {
  EXPECT_EQ(found({"left.png", "right.png", "calibration.yml"}).calibration,
            path("100%/calibration.yml"));
  const RecordingFiles two = found({"left.png", "right.png", "intrinsics.yml", "extrinsics.yml"});
  EXPECT_EQ(two.calibration, path("100%/intrinsics.yml"));
  EXPECT_EQ(two.extrinsics, path("100%/extrinsics.yml"));
  EXPECT_TRUE(found({"left.png", "right.png"}).calibration.empty());
}

TEST_F(FindRecordingTest, NoneAndSeveralPairsAreRefused) {
  const auto message = [&](const std::vector<std::string>& names) {
    return message_of<DataError>([&] { found(names); });
  };
  EXPECT_THAT(message({"left_0.png", "notes.txt"}),
              AllOf(HasSubstr("no pair was found among 1 "), HasSubstr("--left and --right")));
  EXPECT_THAT(message({"a_left.png", "a_right.png", "b_left.png", "b_right.png"}),
              AllOf(HasSubstr("a_left.png"), HasSubstr("b_left.png"), HasSubstr("--left")));
}

}  // namespace
}  // namespace hypotrack::test
