#include <algorithm>
#include <csignal>
#include <thread>

#include "live_test.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

class RecordTest : public LiveTest {
 protected:
  Outcome record(const std::string& text, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"record", scene(text), "--out", path("out").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  }
  /// Records the recording once more: what a run of it sees, and when.
  void expect_replay_is_equal() const {
    const Outcome again = run_program({"record", path("out/scene.yaml").string(), "--out",
                                       path("again").string(), "--format", "png"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(read_text(path("again/times.csv")), read_text(path("out/times.csv")));
    EXPECT_EQ(read_text(path("again/calibration.yaml")), read_text(path("out/calibration.yaml")));
    for (const std::string& name : names_in(path("again"))) {
      if (!name.ends_with(".png")) continue;
      const cv::Mat replayed = read_picture(path("again") / name);
      const std::string stem = std::filesystem::path(name).stem();
      cv::Mat recorded = read_picture(path("out") / (stem + ".png"));
      if (recorded.empty()) recorded = read_picture(path("out") / (stem + ".jpg"));
      ASSERT_EQ(replayed.size(), recorded.size()) << name;
      EXPECT_EQ(cv::norm(replayed, recorded, cv::NORM_INF), 0) << name;
    }
  }
  std::size_t pictures_in(const std::string& name, const std::string& start) const {
    const auto names = names_in(path(name));
    return static_cast<std::size_t>(std::ranges::count_if(
        names, [&](const std::string& file) { return file.starts_with(start); }));
  }
  /// Waits until a recording that goes on has some pairs, or ends.
  void wait_for_pairs(Program& program, std::size_t pairs) const {
    while (program.running() && pictures_in(".part.out", "right_") < pairs)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
};

TEST_F(RecordTest, ARecordingHoldsThePicturesThatTheCameraSent) {
  const MjpegServer both(pictures("both"));
  const Outcome outcome = record(live_scene(one_device(both)), {"--frames", "7"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("camera: 7 pairs"), HasSubstr("7 frames (0 missing); recording in")));
  EXPECT_THAT(lines_of(read_text(path("out/times.csv"))), SizeIs(8));
  for (int i = 0; i < 7; ++i) {
    const cv::Mat left = read_picture(path(cv::format("out/left_%06d.png", i)));
    const cv::Mat right = read_picture(path(cv::format("out/right_%06d.png", i)));
    cv::Mat whole;
    cv::hconcat(left, right, whole);
    int equal = 0;
    for (int sent = 0; sent < 5; ++sent) {
      const cv::Mat picture = read_picture(path(cv::format("rendered/both_%d.jpg", sent)));
      equal += cv::norm(whole, picture, cv::NORM_INF) == 0;
    }
    EXPECT_EQ(equal, 1) << i;
  }
}

TEST_F(RecordTest, ReplayIsEqualBitForBitAndInTime) {
  const MjpegServer left(pictures("left"), {"--jitter", "0.01"});
  const MjpegServer right(pictures("right"), {"--jitter", "0.01"});
  ASSERT_EQ(record(live_scene(two_devices(left, right)), {"--frames", "8"}).exit_code, 0);
  expect_replay_is_equal();
  const Outcome tracked =
      run_program({"run", path("out/scene.yaml").string(), "--out", path("tracked").string()});
  EXPECT_EQ(tracked.exit_code, 0) << tracked.err;
  EXPECT_THAT(lines_of(read_text(path("tracked/track.csv"))), SizeIs(9));
}

TEST_F(RecordTest, PicturesMayBeJpeg) {
  const MjpegServer both(pictures("both"));
  ASSERT_EQ(record(live_scene(one_device(both)), {"--frames", "4", "--format", "jpeg"}).exit_code,
            0);
  EXPECT_THAT(names_in(path("out")),
              AllOf(Contains("left_000000.jpg"), Contains("right_000003.jpg"),
                    Not(Contains("left_000000.png"))));
  expect_replay_is_equal();
}

TEST_F(RecordTest, AFrameThatIsMissingIsMissingInTheRecording) {
  const MjpegServer both(pictures("both"), {"--gone-file", path("gone").string()});
  Start start;
  start.arguments = {"record", scene(live_scene(one_device(both) + "  timeout_s: 0.5\n")), "--out",
                     path("out").string()};
  start.err = path("said");
  Program program(start);
  wait_for_pairs(program, 1);
  write_text(path("gone"), "");
  while (program.running() && read_text(path("said")).find("frame ") == std::string::npos)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const std::size_t before = pictures_in(".part.out", "right_");
  std::filesystem::remove(path("gone"));
  wait_for_pairs(program, before + 1);
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 0) << read_text(path("said"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("recording in"), Not(HasSubstr("(0 missing)"))));
  const Outcome tracked =
      run_program({"run", path("out/scene.yaml").string(), "--out", path("tracked").string()});
  ASSERT_EQ(tracked.exit_code, 0) << tracked.err;
  const std::vector<std::string> rows = lines_of(read_text(path("tracked/track.csv")));
  const auto rows_with = [&](const std::string& text) {
    return std::ranges::count_if(
        rows, [&](const std::string& row) { return row.find(text) != std::string::npos; });
  };
  const auto missing = rows_with(",missing,");
  EXPECT_GE(missing, 1);
  EXPECT_EQ(rows.size(), 1 + missing + pictures_in("out", "right_"));
  EXPECT_EQ(rows_with(",nan,0,0.000,"), missing) << "only missing frames are not searched";
}

TEST_F(RecordTest, CtrlCEndsACamerasRecordingWhole) {
  const MjpegServer both(pictures("both"));
  Start start;
  start.arguments = {"record", scene(live_scene(one_device(both))), "--out", path("out").string()};
  Program program(start);
  wait_for_pairs(program, 4);
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(path(".part.out")));
  EXPECT_EQ(pictures_in("out", "left_"), pictures_in("out", "right_"));
  expect_replay_is_equal();
}

TEST_F(RecordTest, CtrlCBeforeTheLimitIsSaid) {
  const MjpegServer both(pictures("both"));
  Start start;
  start.arguments = {"record",    scene(live_scene(one_device(both))),
                     "--out",     path("out").string(),
                     "--seconds", "3600"};
  Program program(start);
  wait_for_pairs(program, 4);
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; the recording ends early"));
  EXPECT_THAT(names_in(path("out")), Contains("scene.yaml"));
}

TEST_F(RecordTest, ACameraThatIsGoneLeavesItsRecording) {
  const MjpegServer both(pictures("both"), {"--gone-file", path("gone").string()});
  Start start;
  start.arguments = {"record",
                     scene(live_scene(one_device(both) + "  timeout_s: 0.5\n  give_up_s: 1\n")),
                     "--out", path("out").string()};
  Program program(start);
  wait_for_pairs(program, 4);
  write_text(path("gone"), "");
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no pair of pictures for 1 s"));
  EXPECT_THAT(outcome.out, HasSubstr("recording in"));
  expect_replay_is_equal();
}

TEST_F(RecordTest, ARenderedSourceIsRecordedUntilASecond) {
  // Five frames at 30 per second.
  ASSERT_EQ(record(box_scene(), {"--seconds", "0.1"}).exit_code, 0);
  EXPECT_EQ(pictures_in("out", "right_0"), 3u);
  for (int i = 0; i < 3; ++i) {
    const std::string name = cv::format("left_%06d.png", i);
    EXPECT_EQ(read_text(path("out") / name), read_text(path("rendered") / name));
  }
}

TEST_F(RecordTest, ASourceWithoutUsableFramesLeavesNothing) {
  // Servers keep the clock's time: without jitter pictures of both may arrive at once.
  const MjpegServer left(pictures("left")), right(pictures("right"), {"--jitter", "0.01"});
  const std::string never = "  tolerance_ms: 0\n  timeout_s: 0.2\n";
  const Outcome outcome = record(live_scene(two_devices(left, right) + never), {"--frames", "2"});
  expect_refusal(outcome, {"the source gave no usable frame"});
}

TEST_F(RecordTest, UnknownFormatsAndLimitsAreMistakesOfUsage) {
  EXPECT_EQ(record(box_scene(), {"--format", "avi"}).exit_code, 2);
  EXPECT_EQ(record(box_scene(), {"--seconds", "0"}).exit_code, 2);
  EXPECT_EQ(run_program({"record", scene(box_scene())}).exit_code, 2);
}

}  // namespace
}  // namespace hypotrack::test
