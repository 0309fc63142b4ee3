#include "hypotrack/api/calibration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/pictures/orientation.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

constexpr std::array<std::string_view, 3> kUnitNames = {"m", "cm", "mm"};
constexpr std::array<std::string_view, 3> kModelNames = {"none", "brown", "fisheye"};
constexpr std::array<double, 3> kMetresPerUnit = {1.0, 1e-2, 1e-3};

// Plausible baselines of cameras before a table or a person. Closer ones have no parallax; those
// further apart do not see one place well. Other values are almost always a wrong unit.
constexpr double kNearestCameras = 0.005;  // metres
constexpr double kFurthestCameras = 2.0;

void check_baselines(const std::vector<Camera>& cameras, const CalibrationSettings& settings) {
  const auto centre = [](const Camera& c) -> Eigen::Vector3d {
    return c.camera_from_world.inverse().translation();
  };
  const std::filesystem::path& file =
      settings.extrinsics.empty() ? settings.file : settings.extrinsics;
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    const double distance = (centre(cameras[i]) - centre(cameras[0])).norm();
    if (distance >= kNearestCameras && distance <= kFurthestCameras) continue;
    std::string advice;
    if (distance > kFurthestCameras) {
      advice =
          "If the file is in millimetres, write `units: mm`; if it is in checkerboard squares, "
          "give their side as `scale`";
    } else {
      advice = "If the file is in metres, `units` and `scale` must say so";
    }
    throw DataError(fmt::format(
        "{}: the baseline between cameras 0 and {} is {:.6g} m; expected {:g} m to {:g} m. {}. If "
        "the cameras really are that far apart, write `any_baseline: true`",
        file.string(), i, distance, kNearestCameras, kFurthestCameras, advice));
  }
}

/// Returns the size that the settings give; zeros if they give none.
ImageSize size_in(const CalibrationSettings& settings) {
  const auto& size = settings.image_size;
  if (size.empty()) return {};
  const auto whole = [](double v) { return v >= 1 && v <= 65536 && v == std::floor(v); };
  if (size.size() != 2 || !whole(size[0]) || !whole(size[1])) {
    throw DataError(fmt::format("{}: image_size is [{}]; expected [width, height] in whole pixels",
                                settings.file.string(), fmt::join(size, ", ")));
  }
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

void apply_size(std::vector<NamedCamera>& cameras, const ConfigNode& file,
                const CalibrationSettings& settings) {
  const ImageSize given = size_in(settings);
  const ImageSize common = calibration::read_size(file);
  for (auto& [name, camera] : cameras) {
    if (camera.width == 0) {
      camera.width = common.width;
      camera.height = common.height;
    }
    if (given.width == 0) continue;
    if (camera.width == 0) {
      camera.width = given.width;
      camera.height = given.height;
    }
    fit_image_size(camera, given.width, given.height, "image_size");
  }
}

/// Throws DataError on a file of very many keys: a look at each would take hours.
void check_size(const ConfigNode& file, const CalibrationSettings& settings) {
  constexpr std::size_t kMostKeys = 10'000;
  for (const ConfigNode& node : {file, file.get("cameras")}) {
    if (node.size() <= kMostKeys) continue;
    throw DataError(
        fmt::format("{}: is no calibration: it has {} keys or cameras; expected {} at "
                    "most",
                    settings.file.string(), node.size(), kMostKeys));
  }
}

/// Notes the settings that name files which this format has no use for.
void note_unused_files(const CalibrationSettings& settings, Calibration& out) {
  const bool each_alone =
      out.format == "ROS camera_info" || out.format == "OpenCV camera" || out.format == "EuRoC";
  const bool apart =
      out.format == "OpenCV stereo" || (out.format == "OpenCV camera" && !settings.second.empty());
  const auto note = [&](const char* key, const std::filesystem::path& file, bool used) {
    if (used || file.empty()) return;
    out.notes.push_back(fmt::format("{}: not read: `{}` is of no use with a file of {}",
                                    file.string(), key, out.format));
  };
  note("second", settings.second, each_alone);
  note("extrinsics", settings.extrinsics, apart);
}

Calibration read_any(const ConfigNode& file, const CalibrationSettings& settings,
                     const ImageSize& pictures) {
  using namespace calibration;
  check_size(file, settings);
  Calibration out;
  const auto is = [&](const char* format, bool found) {
    if (found) out.format = format;
    return found;
  };
  const ConfigNode list = file.get("cameras");
  const ImageSize given = size_in(settings);
  if (is("ZED", is_zed(file))) {
    out.cameras = read_zed(file, settings, given.width != 0 ? given : pictures, out.notes);
  } else if (is("hypotrack", list.defined() && !list.is_map())) {
    out.cameras = read_camera_list(file, settings, out.notes);
  } else if (is("OpenCV stereo",
                first_of(file, {"M1", "K1", "cameraMatrix1", "M2", "K2", "cameraMatrix2"})
                    .defined())) {
    out.cameras = read_opencv_stereo(file, settings, out.notes);
  } else if (is("ROS camera_info", is_ros(file))) {
    out.cameras = read_ros(file, settings, out.notes);
  } else if (is("OpenCV camera", first_of(file, {"camera_matrix", "Camera_Matrix"}).defined())) {
    out.cameras = read_opencv_single(file, settings, out.notes);
  } else if (is("depthai (OAK)", is_depthai(file))) {
    out.cameras = read_depthai(file, settings, out.notes);
  } else if (is("ORB-SLAM", is_orb_slam(file))) {
    out.cameras = read_orb_slam(file, settings, out.notes);
  } else if (is("EuRoC", is_euroc(file))) {
    out.cameras = read_euroc(file, settings, out.notes);
  } else if (is("Kalibr", file.get("cam0").get("intrinsics").defined())) {
    out.cameras = read_kalibr(file, settings, out.notes);
  } else {
    out.format = "caliscope or anipose";
    out.cameras = read_camera_tables(file, settings, out.notes);
  }
  if (out.cameras.empty()) {
    const std::vector<std::string> keys = file.keys();
    throw DataError(fmt::format(
        "{}: is no calibration; expected `cameras`, M1 and M2 as stereo_calib writes them, "
        "camera_matrix, a camchain of Kalibr, a camera_info of ROS, a ZED's .conf, a sensor.yaml "
        "of EuRoC, settings of ORB-SLAM, a calibration of depthai or the TOML of caliscope. Found: "
        "{}",
        settings.file.string(),
        keys.empty() ? "no key" : fmt::format("{}", fmt::join(keys, ", "))));
  }
  note_unused_files(settings, out);
  return out;
}

/// Notes cameras whose file names another lens model than the settings.
void note_unused_model(const CalibrationSettings& settings, Calibration& out) {
  if (!settings.model) return;
  const auto name_of = [](DistortionModel model) {
    return kModelNames[static_cast<std::size_t>(model)];
  };
  for (const auto& [name, camera] : out.cameras) {
    if (camera.distortion_model == *settings.model) continue;
    out.notes.push_back(fmt::format(
        "{}: `model: {}` is not used for camera {}: the file's lens is {}", settings.file.string(),
        name_of(*settings.model), name, name_of(camera.distortion_model)));
  }
}

/// Keeps the cameras that the settings name, in that order.
void choose(std::vector<NamedCamera>& cameras, const CalibrationSettings& settings) {
  if (settings.cameras.empty()) return;
  std::vector<NamedCamera> chosen;
  for (const std::string& name : settings.cameras) {
    const auto found = std::ranges::find(cameras, name, &NamedCamera::name);
    if (found == cameras.end()) {
      std::vector<std::string> names;
      for (const NamedCamera& camera : cameras) names.push_back(camera.name);
      throw DataError(fmt::format("{}: has no camera '{}'; expected {}", settings.file.string(),
                                  name, fmt::join(names, ", ")));
    }
    chosen.push_back(*found);
  }
  cameras = std::move(chosen);
}

/// Returns the camera with a size to check it by. A file may leave the size to the first image.
Camera with_a_size(Camera camera) {
  static constexpr double kSmallest = 64, kLargest = 65536;
  if (camera.width != 0) return camera;
  const auto size_about = [](double centre) {
    return static_cast<int>(std::clamp(2 * std::abs(centre), kSmallest, kLargest));
  };
  camera.width = size_about(camera.cx);
  camera.height = size_about(camera.cy);
  return camera;
}

}  // namespace

std::span<const std::string_view> enum_names(LengthUnit) { return kUnitNames; }
double metres_per(LengthUnit unit) { return kMetresPerUnit[static_cast<std::size_t>(unit)]; }
std::span<const std::string_view> enum_names(DistortionModel) { return kModelNames; }

Calibration read_calibration(const CalibrationSettings& settings, const ImageSize& pictures) {
  const ConfigNode file = read_calibration_text(settings.file);
  Calibration out = read_any(file, settings, pictures);
  choose(out.cameras, settings);
  note_unused_model(settings, out);
  apply_size(out.cameras, file, settings);
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < out.cameras.size(); ++i) {
    cameras.push_back(out.cameras[i].camera);
    validate(with_a_size(cameras[i]), fmt::format("{}: camera {}", settings.file.string(), i));
  }
  if (!settings.any_baseline) check_baselines(cameras, settings);
  return out;
}

std::vector<Camera> load_calibration(const CalibrationSettings& settings, const ImageSize& pictures,
                                     std::vector<std::string>* notes) {
  Calibration read = read_calibration(settings, pictures);
  if (notes) *notes = std::move(read.notes);
  std::vector<Camera> out;
  for (NamedCamera& camera : read.cameras) out.push_back(std::move(camera.camera));
  return out;
}

void fit_image_size(Camera& camera, int width, int height, std::string_view where) {
  if (camera.width == 0 && camera.height == 0) {
    camera.width = width;
    camera.height = height;
    if (camera.fx != 0) validate(camera, fmt::format("the calibration for {}", where));
  }
  if (camera.width == width && camera.height == height) return;
  throw DataError(
      fmt::format("{}: the image is {}x{} pixels, but its camera is calibrated for "
                  "{}x{}; expected the calibration of this resolution{}",
                  where, width, height, camera.width, camera.height,
                  advice_on_turn(width, height, camera.width, camera.height)));
}

}  // namespace hypotrack
