#include <csignal>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "app_test.hpp"
#include "hypotrack/api/calibration.hpp"
#include "mjpeg_server.hpp"
#include "rendered_board.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A rendered board, held still in one pose after the other before two cameras of this machine.
class LiveCalibrationTest : public AppTest {
 protected:
  /// Writes the pictures of the first poses as JPEG, each for some moments of 1/20 s.
  void hold_poses(std::size_t poses, int moments = 13) const {
    for (std::size_t i = 0; i < poses; ++i) {
      const cv::Mat left = board_.picture(0, RenderedBoard::poses()[i]);
      const cv::Mat right = board_.picture(1, RenderedBoard::poses()[i]);
      write("left", i, left, moments);
      write("right", i, right, moments);
      cv::Mat both;
      cv::hconcat(left, right, both);
      write("both", i, both, moments);
    }
  }
  void show_nothing() const {
    write("left", 0, cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(20)), 1);
    write("right", 0, cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(120)), 1);
  }
  MjpegServer server(const std::string& view, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"--rate", "20"});
    return MjpegServer(path(view + "_*.jpg"), more);
  }
  std::vector<std::string> command(const std::vector<std::string>& cameras) const {
    std::vector<std::string> out{
        "calibrate", "--board", "9x6", "--square", "25mm", "--out", path("rig.yaml").string()};
    out.insert(out.end(), cameras.begin(), cameras.end());
    return out;
  }
  Start start(const std::vector<std::string>& cameras) const {
    Start out;
    out.arguments = command(cameras);
    return out;
  }
  /// Waits until a program has taken some pairs, or ended.
  void wait_for_pairs(Program& program, int count) const {
    const auto last = path(cv::format("rig_pairs/right_%02d.png", count));
    while (program.running() && !std::filesystem::exists(last))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  void expect_nothing_written() const {
    EXPECT_FALSE(std::filesystem::exists(path("rig.yaml")));
    EXPECT_FALSE(std::filesystem::exists(path("rig_pairs")));
  }

  RenderedBoard board_;

 private:
  void write(const std::string& view, std::size_t pose, const cv::Mat& image, int moments) const {
    const auto file = path(cv::format("%s_%02d_00.jpg", view.c_str(), static_cast<int>(pose)));
    cv::imwrite(file.string(), image, {cv::IMWRITE_JPEG_QUALITY, 98});
    for (int i = 1; i < moments; ++i)
      std::filesystem::create_symlink(
          file, path(cv::format("%s_%02d_%02d.jpg", view.c_str(), static_cast<int>(pose), i)));
  }
};

TEST_F(LiveCalibrationTest, PairsAreTakenUntilTheySufficeAndGiveTheCameras) {
  hold_poses(RenderedBoard::poses().size());
  const MjpegServer left = server("left"), right = server("right");
  const Outcome outcome =
      run_program(command({"--left", left.url(), "--right", right.url(), "--seconds", "120"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("good: "), HasSubstr("left_12.png")));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("pair 1 taken (left_01.png)"), HasSubstr("; next: "),
                                 HasSubstr("to calibrate from them:")));
  CalibrationSettings settings;
  settings.file = path("rig.yaml");
  const std::vector<Camera> cameras = load_calibration(settings);
  ASSERT_EQ(cameras.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(cameras[i].fx, board_.cameras[i].fx, 3);
    EXPECT_NEAR(cameras[i].cx, board_.cameras[i].cx, 3);
  }
  EXPECT_NEAR(cameras[1].camera_from_world.translation().x(), -0.06, 0.0006);
}

TEST_F(LiveCalibrationTest, StoredPairsGiveTheSameCalibration) {
  hold_poses(5);
  const MjpegServer both = server("both");
  Program program(start({"--device", both.url()}));
  wait_for_pairs(program, 5);
  program.signal(SIGINT);  // with enough pairs: calibrate
  const Outcome outcome = program.wait();
  EXPECT_THAT(outcome.out, HasSubstr("calibration in " + path("rig.yaml").string()));
  const std::string pairs = path("rig_pairs").string(), again = path("again.yaml").string();
  run_program({"calibrate", "--board", "9x6", "--square", "25mm", "--left", pairs + "/left_*.png",
               "--right", pairs + "/right_*.png", "--out", again});
  EXPECT_EQ(read_text(path("rig.yaml")), read_text(again));
  EXPECT_NE(read_text(again), "");
}

TEST_F(LiveCalibrationTest, EnterEndsTheTakingWithThePairsSoFar) {
  hold_poses(4);
  const MjpegServer both = server("both");
  const std::string pair = path("rig_pairs/right_04.png").string();
  std::string line = "{ echo; while [ ! -e " + pair +
                     " ]; do sleep 0.05; done; echo; sleep 60; } | " +
                     (build_dir() / "bin/hypotrack").string();
  for (const std::string& word : command({"--device", both.url()})) line += " '" + word + "'";
  const std::string out = path("out").string(), err = path("err").string();
  Subprocess shell({.program = "/bin/sh", .arguments = {"-c", line}, .output = out, .errors = err});
  while (shell.running() && read_text(out).find("calibration in") == std::string::npos)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_THAT(read_text(err), HasSubstr("0 pairs; a calibration needs 3 at least"));
  EXPECT_THAT(read_text(out), HasSubstr("over 4 pairs"));
}

TEST_F(LiveCalibrationTest, ABoardThatIsNeverSeenIsSaidWithTheReason) {
  show_nothing();
  const MjpegServer left = server("left"), right = server("right");
  const Outcome outcome =
      run_program(command({"--left", left.url(), "--right", right.url(), "--seconds", "0.6"}));
  expect_refusal(outcome, {"0 pairs were taken; a calibration needs 3 at least",
                           "left: too dark, right: nothing is seen: is the lens covered?"});
  expect_nothing_written();
}

TEST_F(LiveCalibrationTest, CtrlCBeforeAnythingIsTakenLeavesNothing) {
  show_nothing();
  const MjpegServer left = server("left"), right = server("right");
  Start begun = start({"--left", left.url(), "--right", right.url()});
  begun.err = path("said");
  Program program(begun);
  while (program.running() && read_text(begun.err).find("too dark") == std::string::npos)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait().exit_code, 130);
  EXPECT_THAT(read_text(begun.err), HasSubstr("nothing was written"));
  expect_nothing_written();
}

TEST_F(LiveCalibrationTest, AStreamThatStopsIsSaidAndTakenPairsStay) {
  hold_poses(4);
  const MjpegServer both = server("both", {"--stop-after", "80"});
  const Outcome outcome = run_program(command({"--device", both.url(), "--seconds", "6"}));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("cannot be opened"), HasSubstr("the pairs are in ")));
  EXPECT_THAT(outcome.out, HasSubstr("calibration in"));
}

TEST_F(LiveCalibrationTest, AStreamThatNobodyServesEndsItWithOneMessage) {
  expect_refusal(run_program(command({"--device", "http://127.0.0.1:1/stream"})),
                 {"the stream cannot be opened; is the address right"});
  expect_nothing_written();
}

TEST_F(LiveCalibrationTest, AFolderThatHoldsPicturesIsNotTouched) {
  show_nothing();
  std::filesystem::create_directory(path("rig_pairs"));
  write_text(path("rig_pairs/left_01.png"), "mine");
  const MjpegServer left = server("left"), right = server("right");
  expect_refusal(run_program(command({"--left", left.url(), "--right", right.url()})),
                 {"rig_pairs: is not empty; name another folder for the pairs with --pairs"});
  EXPECT_THAT(names_in(path("rig_pairs")), ElementsAre("left_01.png"));
}

TEST_F(LiveCalibrationTest, CamerasAndFilesAreNotMixed) {
  const auto refused = [&](const std::vector<std::string>& cameras, const std::string& message) {
    expect_refusal(run_program(command(cameras)), {message});
  };
  refused({"--left", "0", "--right", "right*.png"}, "one is a live camera; expected both or none");
  refused({"--device", "0", "--left", "1", "--right", "2"}, "--device has both views");
  refused({"--device", "0", "--size", "1280"}, "--size is '1280'");
  refused({"--left", "l*.png", "--right", "r*.png", "--fps", "30"}, "set live cameras");
  refused({"--left", "l*.png", "--right", "r*.png", "--seconds", "9"}, "belong to live cameras");
  refused({}, "expected --left and --right, or --device");
}

}  // namespace
}  // namespace hypotrack::test
