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
  const MjpegServer both(pictures("both"), {"--stop-after", "30"});
  const Outcome outcome = run(live_scene(one_device(both) + "  timeout_s: 0.5\n  give_up_s: 2\n"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("hypotrack: source camera: no pair of pictures for 2 s"),
                    HasSubstr("holds the frames so far"), ContainsRegex("camera: [0-9]+ pairs")));
  const std::string track = read_text(path("out/track.csv"));
  EXPECT_THAT(track, AllOf(HasSubstr(",tracked,"), HasSubstr(",missing,")));
}

TEST_F(LiveRunTest, AStreamThatNobodyServesEndsItWithOneMessage) {
  const Outcome outcome = run(live_scene("  device: \"http://127.0.0.1:1/stream\"\n"));
  expect_refusal(outcome, {"the stream cannot be opened; is the address right"});
}

}  // namespace
}  // namespace hypotrack::test
