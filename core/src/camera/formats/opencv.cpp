#include <utility>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

// Names in files of one camera. Older programs of OpenCV and Metashape write large letters.
const std::initializer_list<std::string_view> kOneMatrix = {"camera_matrix", "Camera_Matrix"};
const std::initializer_list<std::string_view> kOneLens = {"distortion_coefficients", "dist_coeffs",
                                                          "Distortion_Coefficients"};

const KnownButUnused kFollowsFromPose{
    "rectification, which follows from R and T",
    {"R1", "R2", "P1", "P2", "Q", "E", "F", "roi*", "validRoi*", "validPixROI*"}};

/// Returns what the calibration programs of OpenCV tell of their work, beside the cameras.
KeyPaths keys_of_the_work() {
  return {"calibration_time",
          "calibration_Time",
          "calibrationDate",
          "nframes",
          "nr_of_frames",
          "nrOfFrames",
          "board_Width",
          "board_Height",
          "square_Size",
          "framesCount",
          "board_width",
          "board_height",
          "square_size",
          "marker_size",
          "aspectRatio",
          "fix_aspect_ratio",
          "flags",
          "avg_reprojection_error",
          "per_view_reprojection_errors/**",
          "extrinsic_parameters/**",
          "image_points/**",
          "grid_points/**",
          "rms",
          "reprojection_error",
          "cameraMatrix_std_dev/**",
          "dist_coeffs_std_dev/**"};
}

/// Throws DataError if a file is of cv::omnidir, whose coefficients mean another lens.
void expect_no_omnidirectional_lens(const ConfigNode& file) {
  for (const char* key : {"xi", "xi1", "xi2", "xi_1", "xi_2"}) {
    const ConfigNode xi = file.get(key);
    if (!xi.defined()) continue;
    throw DataError(
        fmt::format("{}: xi is of OpenCV's omnidirectional lens, which is not read; expected the "
                    "lens of cv::calibrateCamera or cv::fisheye: calibrate with cv::fisheye",
                    xi.where()));
  }
}

/// Notes what a file with R and T has beside them.
void note_unused_of_pose(const ConfigNode& pose, const std::string& file_name,
                         std::vector<std::string>& notes) {
  KeyPaths used = keys_of_the_work();
  append({"R", "T", "units"}, used);
  append(size_keys(""), used);
  note_unused_keys(pose, file_name, used, {kFollowsFromPose}, notes);
}

/// Returns the lens model that a file of the calibration program names, or that of the settings.
std::optional<DistortionModel> model_of(const ConfigNode& file,
                                        const CalibrationSettings& settings) {
  const ConfigNode fisheye = file.get("fisheye_model");
  if (!fisheye.defined()) return settings.model;
  constexpr std::array<std::string_view, 4> kWords = {"0", "1", "false", "true"};
  if (index_of(fisheye, "fisheye_model", kWords) % 2 == 0) return settings.model;
  return DistortionModel::fisheye;
}

/// Reads a lens. Notes that a file has none.
void read_opencv_lens(const ConfigNode& file, std::initializer_list<std::string_view> names,
                      std::optional<DistortionModel> model, Camera& camera,
                      std::vector<std::string>& notes) {
  const ConfigNode lens = first_of(file, names);
  read_lens(lens, model, camera);
  if (!lens.defined() && model != DistortionModel::none)
    notes.push_back(
        fmt::format("{}: has no {}; no distortion is taken for it", file.where(), *names.begin()));
}

Camera read_one(const ConfigNode& file, const CalibrationSettings& settings,
                const std::string& file_name, std::vector<std::string>& notes) {
  Camera camera;
  expect_no_omnidirectional_lens(file);
  read_intrinsics(first_of(file, kOneMatrix), camera);
  read_opencv_lens(file, kOneLens, model_of(file, settings), camera, notes);
  KeyPaths used = keys_of_the_work();
  used.insert(used.end(), kOneMatrix.begin(), kOneMatrix.end());
  used.insert(used.end(), kOneLens.begin(), kOneLens.end());
  append({"fisheye_model", "units"}, used);
  append(size_keys(""), used);
  note_unused_keys(file, file_name, used, {kFollowsFromPose}, notes);
  return camera;
}

/// Notes what a file with two cameras has beside them. R and T in it are not used where
/// `extrinsics` names another file.
void note_unused_of_stereo(const ConfigNode& file, const CalibrationSettings& settings,
                           std::vector<std::string>& notes) {
  KeyPaths used = keys_of_the_work();
  append({"M1", "M2", "K1", "K2", "cameraMatrix1", "cameraMatrix2", "D1", "D2", "distCoeffs1",
          "distCoeffs2", "units"},
         used);
  append(size_keys(""), used);
  KnownButUnused pose{"`extrinsics` names another file", {"R", "T"}};
  if (settings.extrinsics.empty()) append(std::exchange(pose.paths, {}), used);
  note_unused_keys(file, settings.file.string(), used, {kFollowsFromPose, pose}, notes);
}

void take_size(const ConfigNode& file, Camera& camera) {
  const ImageSize size = read_size(file);
  camera.width = size.width;
  camera.height = size.height;
}

}  // namespace

std::vector<NamedCamera> read_opencv_stereo(const ConfigNode& file,
                                            const CalibrationSettings& settings,
                                            std::vector<std::string>& notes) {
  std::vector<NamedCamera> cameras{{"1", {}}, {"2", {}}};
  expect_no_omnidirectional_lens(file);
  constexpr std::string_view kNeedsBoth = "expected M1, D1, M2, D2 as stereo_calib writes them";
  read_intrinsics(required(file, {"M1", "K1", "cameraMatrix1"}, kNeedsBoth), cameras[0].camera);
  read_intrinsics(required(file, {"M2", "K2", "cameraMatrix2"}, kNeedsBoth), cameras[1].camera);
  read_opencv_lens(file, {"D1", "distCoeffs1"}, settings.model, cameras[0].camera, notes);
  read_opencv_lens(file, {"D2", "distCoeffs2"}, settings.model, cameras[1].camera, notes);
  const ConfigNode pose =
      settings.extrinsics.empty() ? file : read_calibration_text(settings.extrinsics);
  constexpr std::string_view kTwoFiles =
      "stereo_calib writes R and T to a second file, extrinsics.yml: name it under `extrinsics`";
  read_pose(required(pose, {"R"}, kTwoFiles), required(pose, {"T"}, kTwoFiles),
            metres_per_unit(pose, settings), cameras[1].camera);
  note_unused_of_stereo(file, settings, notes);
  if (!settings.extrinsics.empty()) note_unused_of_pose(pose, settings.extrinsics.string(), notes);
  return cameras;
}

std::vector<NamedCamera> read_opencv_single(const ConfigNode& file,
                                            const CalibrationSettings& settings,
                                            std::vector<std::string>& notes) {
  std::vector<NamedCamera> cameras{{"1", read_one(file, settings, settings.file.string(), notes)}};
  if (settings.second.empty()) return cameras;
  const ConfigNode second = read_calibration_text(settings.second);
  required(second, kOneMatrix, "expected the calibration of one camera");
  cameras.push_back({"2", read_one(second, settings, settings.second.string(), notes)});
  take_size(file, cameras[0].camera);
  take_size(second, cameras[1].camera);
  if (settings.extrinsics.empty()) {
    throw DataError(fmt::format(
        "{}: two files of one camera each do not say where the cameras are; name a file with R and "
        "T under `extrinsics`",
        settings.second.string()));
  }
  const ConfigNode pose = read_calibration_text(settings.extrinsics);
  constexpr std::string_view kPose = "expected R and T, p_second = R p_first + T";
  read_pose(required(pose, {"R"}, kPose), required(pose, {"T"}, kPose),
            metres_per_unit(pose, settings), cameras[1].camera);
  note_unused_of_pose(pose, settings.extrinsics.string(), notes);
  return cameras;
}

}  // namespace hypotrack::calibration::internal
