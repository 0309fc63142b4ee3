#include <thread>

#include "live_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::SizeIs;

using LiveRunTest = LiveTest;

TEST_F(LiveRunTest, TwoCamerasAreTrackedAndTheirPicturesCounted) {
  const MjpegServer left(pictures("left")), right(pictures("right"));
  const Outcome outcome = run(live_scene(two_devices(left, right)), {"--frames", "6"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(lines_of(read_text(path("out/track.csv"))), SizeIs(7));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("camera: 6 pairs at "), HasSubstr("offset"),
                                 HasSubstr("camera: left (" + left.url() + "): "),
                                 HasSubstr("camera: right (" + right.url() + "): ")));
}

TEST_F(LiveRunTest, CountsReachTheUserThroughAWrappedSource) {
  const MjpegServer both(pictures("both"));
  const std::string text =
      replaced(live_scene(one_device(both)),
               "source:\n  type: camera\n  calibration: {file: rendered/calibration.yaml}\n" +
                   one_device(both),
               "source:\n  type: depth_from_stereo\n  source: {type: camera, device: \"" +
                   both.url() + "\", calibration: {file: rendered/calibration.yaml}}\n");
  const Outcome outcome =
      run_program({"record", scene(text), "--out", path("out").string(), "--frames", "2"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("camera: 2 pairs"));
}

TEST_F(LiveRunTest, ACameraThatIsGoneEndsTheRunAndKeepsItsFrames) {
  // One picture over and over: the box stays at its start, however late the run sees it.
  const MjpegServer both(pictures("both"),
                         {"--rate", "10", "--first", "1", "--gone-file", path("gone").string()});
  Start start;
  start.arguments = {"run",
                     scene(live_scene(one_device(both) + "  timeout_s: 0.5\n  give_up_s: 10\n")),
                     "--out", path("out").string()};
  Program program(start);
  while (program.running() &&
         read_text(path("out/track.csv")).find(",tracked,") == std::string::npos)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  write_text(path("gone"), "");
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("hypotrack: source camera: no pair of pictures for 10 s"),
                    HasSubstr("holds the frames so far"), ContainsRegex("camera: [0-9]+ pairs")));
  const std::string track = read_text(path("out/track.csv"));
  EXPECT_THAT(track, AllOf(HasSubstr(",tracked,"), HasSubstr(",missing,")));
}

TEST_F(LiveRunTest, ANewSceneOfLiveCamerasValidatesAndDoesNotWait) {
  const MjpegServer left(pictures("left")), right(pictures("right"));
  const std::string file = path("live.yaml").string();
  const Outcome outcome = run_program(
      {"new", "scene", file, "--left", left.url(), "--right", right.url(), "--calibration",
       path("rendered/calibration.yaml").string(), "--model", "hand", "--tracker", "real_time"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("hypotrack run " + file + " --out result --web 8080"));
  EXPECT_THAT(read_text(file),
              AllOf(HasSubstr("type: camera"), HasSubstr("left: \"" + left.url() + "\""),
                    HasSubstr("file: rendered/calibration.yaml"), HasSubstr("run: background"),
                    HasSubstr("overlay: false"), HasSubstr("@trackers/real_time")));
  const Outcome validated = run_program({"validate", file});
  EXPECT_EQ(validated.exit_code, 0) << validated.err;
}

TEST_F(LiveRunTest, ANewSceneOfADeviceThatIsMissingIsNotWritten) {
  const Outcome outcome = run_program(
      {"new", "scene", path("live.yaml").string(), "--device", "/dev/video99", "--size", "2560x720",
       "--fps", "60", "--pixel-format", "MJPG", "--calibration",
       path("rendered/calibration.yaml").string(), "--model", "hand", "--tracker", "real_time"});
  expect_refusal(outcome, {"/dev/video99: there is no such device", "live.yaml was not written"});
  EXPECT_FALSE(std::filesystem::exists(path("live.yaml")));
}

TEST_F(LiveRunTest, CamerasWithoutACalibrationAreNeitherTrackedNorRecorded) {
  const MjpegServer both(pictures("both"));
  const std::string text =
      replaced(live_scene(one_device(both)), "calibration: {file: rendered/calibration.yaml}",
               "uncalibrated: true");
  expect_refused(text, {"source 'camera' has cameras without a calibration"});
  expect_refusal(run_program({"record", scene(text), "--out", path("out").string()}),
                 {"`hypotrack calibrate` writes"});
}

TEST_F(LiveRunTest, AStreamThatNobodyServesEndsItWithOneMessage) {
  const Outcome outcome = run(live_scene("  device: \"http://127.0.0.1:1/stream\"\n"));
  expect_refusal(outcome, {"the stream cannot be opened; is the address right"});
}

}  // namespace
}  // namespace hypotrack::test
