#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "app_test.hpp"
#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/media.hpp"
#include "rendered_board.hpp"
#include "test_paths.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;

constexpr const char* kCameras = R"(%YAML:1.0
---
units: m
cameras:
  - {image_width: 640, image_height: 480, model: none, K: [500, 0, 320, 0, 500, 240, 0, 0, 1]}
  - {image_width: 640, image_height: 480, model: none, K: [500, 0, 320, 0, 500, 240, 0, 0, 1],
     R: [1, 0, 0, 0, 1, 0, 0, 0, 1], T: [-0.06, 0, 0]}
)";

constexpr const char* kZedFile = R"([LEFT_CAM_HD]
fx=700.895
fy=700.895
cx=665.54
cy=371.155
k1=-0.175995
k2=0.0265533

[RIGHT_CAM_HD]
fx=699.05
fy=699.05
cx=639.74
cy=374.974
k1=-0.175152
k2=0.0267266

[STEREO]
Baseline=120

[NEWS]
a=1
)";

class CalibrationCommandsTest : public AppTest {
 protected:
  std::string cameras() const {
    write_text(path("cameras.yaml"), kCameras);
    return path("cameras.yaml").string();
  }
};

TEST_F(CalibrationCommandsTest, InfoPrintsCamerasAndHowTheyStand) {
  const Outcome outcome = run_program({"calibration", "info", cameras()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("hypotrack, 2 cameras"));
  EXPECT_THAT(outcome.out, HasSubstr("640 x 480 px, focal lengths 500.00 500.00 px"));
  EXPECT_THAT(outcome.out, HasSubstr("baseline 60.00 mm"));
  EXPECT_THAT(outcome.out, HasSubstr("sees 65.2 x 51.3 degrees\n"));
}

TEST_F(CalibrationCommandsTest, InfoSaysWhatTheLensAddsAndWhatIsNotUsed) {
  write_text(path("SN1.conf"), kZedFile);
  const Outcome outcome =
      run_program({"calibration", "info", path("SN1.conf").string(), "--image-size", "1280x720"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("sees 95.9 x 56.7 degrees; without the lens 84.8 x 54.4\n"));
  EXPECT_THAT(outcome.out, HasSubstr("SN1.conf: not used: [NEWS] (not understood)\n"));
  const Outcome converted =
      run_program({"calibration", "convert", path("SN1.conf").string(), "--image-size", "1280x720",
                   "--out", path("zed.yaml").string()});
  EXPECT_EQ(converted.exit_code, 0) << converted.err;
  EXPECT_THAT(converted.err, HasSubstr("note: " + path("SN1.conf").string() + ": not used: "));
}

TEST_F(CalibrationCommandsTest, ValidateSaysWhatOfACalibrationIsNotUsed) {
  write_text(path("SN1.conf"), kZedFile);
  const std::string file = scene(
      replaced(box_scene(), "cameras: {width: 160, height: 120, focal_px: 160, baseline_mm: 80}",
               "calibration: {file: SN1.conf, image_size: [1280, 720]}"));
  const Outcome outcome = run_program({"validate", file});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("SN1.conf: not used: [NEWS] (not understood)\n"));
}

TEST_F(CalibrationCommandsTest, ConvertWritesWhatItReads) {
  const std::string file = cameras(), out = path("converted.yaml").string();
  EXPECT_EQ(run_program({"calibration", "convert", file, "--out", out}).exit_code, 0);
  const Outcome again = run_program({"calibration", "info", out});
  EXPECT_THAT(again.out, HasSubstr("baseline 60.00 mm"));
  expect_refusal(run_program({"calibration", "convert", file, "--out", out}), {out, "--force"});
  EXPECT_EQ(run_program({"calibration", "convert", file, "--out", out, "--force"}).exit_code, 0);
  expect_refusal(
      run_program({"calibration", "convert", file, "--out", path("no/folder.yaml").string()}),
      {"no/folder.yaml"});
}

TEST_F(CalibrationCommandsTest, CheckTellsExchangedPictures) {
  cv::RNG random(3);
  cv::Mat3b wall(480, 800, cv::Vec3b(120, 130, 140));
  for (int i = 0; i < 400; ++i)
    cv::circle(wall, {random.uniform(0, 800), random.uniform(0, 480)}, random.uniform(3, 14),
               cv::Scalar(random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255)),
               cv::FILLED);
  const std::string left = path("left.png").string(), right = path("right.png").string();
  write_image(left, wall(cv::Rect(60, 0, 640, 480)));
  write_image(right, wall(cv::Rect(120, 0, 640, 480)));
  const std::string file = cameras();
  const Outcome good =
      run_program({"calibration", "check", file, "--left", left, "--right", right});
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("calibration and pictures agree"));
  const Outcome exchanged =
      run_program({"calibration", "check", file, "--left", right, "--right", left});
  EXPECT_EQ(exchanged.exit_code, 1);
  EXPECT_THAT(exchanged.out, HasSubstr("left and right are exchanged"));
}

TEST_F(CalibrationCommandsTest, CalibrateRefusesWhatShowsNoBoard) {
  const std::string left = path("left.png").string(), right = path("right.png").string();
  write_image(left, cv::Mat3b(480, 640, cv::Vec3b(90, 90, 90)));
  write_image(right, cv::Mat3b(480, 640, cv::Vec3b(90, 90, 90)));
  const std::string out = path("out").string();
  const auto calibrate = [&](const std::string& of, std::vector<std::string> more) {
    more.insert(more.begin(), {"calibrate", "--left", of, "--right", right, "--out", out});
    return run_program(more);
  };
  expect_refusal(calibrate(left, {"--board", "9x6", "--square", "25mm"}),
                 {"0 of 1 pairs show the board"});
  expect_refusal(calibrate(left, {"--board", "9", "--square", "25mm"}), {"--board is '9'"});
  expect_refusal(calibrate(left, {"--board", "9x6", "--square", "25"}), {"--square is '25'"});
  expect_refusal(calibrate(path("none*.jpg").string(), {"--board", "9x6", "--square", "25mm"}),
                 {"none*.jpg: no such picture"});
  write_image(left, cv::Mat3b(240, 320, cv::Vec3b(90, 90, 90)));
  expect_refusal(calibrate(left, {"--board", "9x6", "--square", "25mm"}), {"320 x 240", "640"});
}

/// Pictures of a rendered board of 9 x 6 inner corners.
class RenderedCalibrationTest : public CalibrationCommandsTest {
 protected:
  RenderedCalibrationTest() {
    const std::vector<Eigen::Isometry3d> poses = RenderedBoard::poses();
    for (std::size_t i = 0; i < poses.size(); ++i)
      for (std::size_t view = 0; view < 2; ++view)
        write_image(path(cv::format("%s_%02zu.png", view == 0 ? "left" : "right", i)).string(),
                    board_.picture(view, poses[i]));
  }
  Outcome run_on_pictures(std::vector<std::string> command, const char* which = "*") const {
    for (const std::string side : {"left", "right"}) {
      command.push_back("--" + side);
      command.push_back(path(side + "_" + which + ".png").string());
    }
    return run_program(command);
  }

  RenderedBoard board_;
};

TEST_F(RenderedCalibrationTest, SquaresInPlaceOfCornersAreNamedSoon) {
  expect_refusal(
      run_on_pictures(
          {"calibrate", "--board", "10x7", "--square", "25mm", "--out", path("rig.yaml").string()}),
      {"--board is 10x7", "pictures show a chessboard of 9x6 inner corners: give --board 9x6"});
}

TEST_F(RenderedCalibrationTest, PicturesThatAreSplitInTheWrongWayEndSoon) {
  for (int i = 0; i < 4; ++i) {
    const auto read = [&](const char* side) {
      return read_image(path(cv::format("%s_%02d.png", side, i)).string());
    };
    cv::Mat beside, above;
    cv::hconcat(read("left"), read("right"), beside);
    cv::vconcat(read("left"), read("right"), above);
    write_image(path(cv::format("beside_%d.png", i)).string(), beside);
    write_image(path(cv::format("above_%d.png", i)).string(), above);
  }
  const auto calibrate = [&](const char* pictures, const char* layout) {
    return run_program({"calibrate", "--left", path(pictures).string(), "--layout", layout,
                        "--board", "9x6", "--square", "25mm", "--out", path("rig.yaml").string()});
  };
  expect_refusal(calibrate("beside_*.png", "top_bottom"),
                 {"none of the first 3 pairs shows the board", "give --layout side_by_side"});
  expect_refusal(calibrate("above_*.png", "side_by_side"),
                 {"seen in both halves, one above the other: give --layout top_bottom"});
}

TEST_F(RenderedCalibrationTest, RepeatedPairsDoNotCount) {
  for (const std::string side : {"left", "right"})
    for (const std::string number : {"01", "02", "03"})
      std::filesystem::copy_file(path(side + "_00.png"), path(side + "_" + number + ".png"),
                                 std::filesystem::copy_options::overwrite_existing);
  expect_refusal(run_on_pictures({"calibrate", "--board", "9x6", "--square", "25mm", "--out",
                                  path("rig.yaml").string()},
                                 "0[0-3]"),
                 {"4 pairs show the board at 1 different places; expected at least 3"});
}

TEST_F(RenderedCalibrationTest, CheckComparesWithTheCamerasOfTheBoardItself) {
  const std::string rig = path("rig.yaml").string();
  run_on_pictures({"calibrate", "--board", "9x6", "--square", "25mm", "--out", rig});
  const auto check = [&] {
    return run_on_pictures({"calibration", "check", rig, "--board", "9x6", "--square", "25mm"},
                           "0[0-8]");
  };
  const Outcome right = check();
  EXPECT_EQ(right.exit_code, 0) << right.out << right.err;
  EXPECT_THAT(right.out, HasSubstr("compared with a calibration from the board: corners are"));
  EXPECT_THAT(right.out, testing::Not(HasSubstr("centres that are some pixels off")));
  CalibrationSettings settings;
  settings.file = rig;
  std::string text = "%YAML:1.0\n---\nunits: m\ncameras:\n";
  for (Camera camera : load_calibration(settings, {320, 240})) {
    camera.cx += 14;  // tangential distortion makes up for most of it
    camera.distortion[3] += 14 / (2 * camera.fx);
    const Eigen::Vector3d at = camera.camera_from_world.translation();
    text += fmt::format(
        "  - {{image_width: 320, image_height: 240, model: brown, K: [{}, 0, {}, 0, {}, {}, 0, 0, "
        "1], D: [{}], R: [{}], T: [{}, {}, {}]}}\n",
        camera.fx, camera.cx, camera.fy, camera.cy, fmt::join(camera.distortion, ", "),
        fmt::join(camera.camera_from_world.linear().transpose().reshaped(), ", "), at.x(), at.y(),
        at.z());
  }
  write_text(rig, text);
  const Outcome wrong = check();
  EXPECT_EQ(wrong.exit_code, 1) << wrong.out;
  EXPECT_THAT(wrong.out, HasSubstr("the board does not agree, calibrate again: corners are"));
  EXPECT_THAT(wrong.out, HasSubstr("whose centres are up to"));
}

TEST_F(RenderedCalibrationTest, CheckMeasuresABoardAndSaysWhatItCannotTell) {
  const std::string rig = path("rig.yaml").string();
  const Outcome made =
      run_on_pictures({"calibrate", "--board", "9x6", "--square", "25mm", "--out", rig});
  EXPECT_THAT(made.out, HasSubstr("good: 0."));
  const Outcome right = run_on_pictures(
      {"calibration", "check", rig, "--board", "9x6", "--square", "25mm"}, "0[0-2]");
  EXPECT_EQ(right.exit_code, 0) << right.out << right.err;
  EXPECT_THAT(right.out, HasSubstr("the board agrees: its squares measure 25.0"));
  EXPECT_THAT(right.out, HasSubstr("these pictures do not tell:\n- anything nearer than"));
  const Outcome wrong =
      run_on_pictures({"calibration", "check", rig, "--board", "9x6", "--square", "30mm"}, "00");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.out, HasSubstr("the board does not agree: its squares measure 25.0"));
  expect_refusal(run_on_pictures({"calibration", "check", rig, "--board", "9x6"}),
                 {"--board and --square belong together"});
}

TEST_F(CalibrationCommandsTest, NotesOnTheLensesAndOnACheckedFileAreShown) {
  write_text(path("SN1.conf"), kZedFile);
  const std::string file = path("SN1.conf").string(), picture = path("picture.png").string();
  write_image(picture, cv::Mat3b(720, 1280, cv::Vec3b(90, 90, 90)));
  const Outcome checked =
      run_program({"calibration", "check", file, "--left", picture, "--right", picture});
  EXPECT_THAT(checked.err, HasSubstr("note: " + file + ": not used: [NEWS] (not understood)\n"));
  const Outcome lenses =
      run_program({"calibrate", "--left", picture, "--right", picture, "--board", "9x6", "--square",
                   "25mm", "--lenses", file, "--out", path("rig.yaml").string()});
  EXPECT_THAT(lenses.err, HasSubstr("note: " + file + ": not used: [NEWS] (not understood)\n"));
}

TEST_F(CalibrationCommandsTest, RealPicturesAreCalibrated) {
  HYPOTRACK_NEEDS_SHARED_DATA();
  const std::string folder = (shared_data() / "calib/chessboard").string();
  const std::string out = path("calibration.yaml").string();
  const Outcome outcome = run_program({"calibrate", "--left", folder + "/left*.jpg", "--right",
                                       folder + "/right*.jpg", "--board", "9x6", "--square", "25mm",
                                       "--out", out, "--coverage", path("coverage.png").string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("good: 0.2"));
  EXPECT_EQ(read_image(path("coverage.png").string()).size(), cv::Size(1280, 480));
  const Outcome info = run_program({"calibration", "info", out});
  EXPECT_THAT(info.out, HasSubstr("baseline 83.18 mm"));
}

}  // namespace
}  // namespace hypotrack::test
