#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"

namespace hypotrack::calibration::internal {
namespace {

Camera read_one(const ConfigNode& file, const CalibrationSettings& settings) {
  Camera camera;
  read_intrinsics(file.get("camera_matrix"), camera);
  read_lens(first_of(file, {"distortion_coefficients", "dist_coeffs"}), settings.model, camera);
  return camera;
}

void take_size(const ConfigNode& file, Camera& camera) {
  const ImageSize size = read_size(file);
  camera.width = size.width;
  camera.height = size.height;
}

}  // namespace

std::vector<NamedCamera> read_opencv_stereo(const ConfigNode& file,
                                            const CalibrationSettings& settings) {
  std::vector<NamedCamera> cameras{{"1", {}}, {"2", {}}};
  constexpr std::string_view kNeedsBoth = "expected M1, D1, M2, D2 as stereo_calib writes them";
  read_intrinsics(required(file, {"M1", "K1", "cameraMatrix1"}, kNeedsBoth), cameras[0].camera);
  read_intrinsics(required(file, {"M2", "K2", "cameraMatrix2"}, kNeedsBoth), cameras[1].camera);
  read_lens(first_of(file, {"D1", "distCoeffs1"}), settings.model, cameras[0].camera);
  read_lens(first_of(file, {"D2", "distCoeffs2"}), settings.model, cameras[1].camera);
  const ConfigNode pose =
      settings.extrinsics.empty() ? file : read_calibration_text(settings.extrinsics);
  constexpr std::string_view kTwoFiles =
      "stereo_calib writes R and T to a second file, extrinsics.yml: name it under `extrinsics`";
  read_pose(required(pose, {"R"}, kTwoFiles), required(pose, {"T"}, kTwoFiles),
            metres_per_unit(pose, settings), cameras[1].camera);
  return cameras;
}

std::vector<NamedCamera> read_opencv_single(const ConfigNode& file,
                                            const CalibrationSettings& settings) {
  std::vector<NamedCamera> cameras{{"1", read_one(file, settings)}};
  if (settings.second.empty()) return cameras;
  const ConfigNode second = read_calibration_text(settings.second);
  required(second, {"camera_matrix"}, "expected the calibration of one camera");
  cameras.push_back({"2", read_one(second, settings)});
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
  return cameras;
}

}  // namespace hypotrack::calibration::internal
