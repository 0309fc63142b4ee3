#include "hypotrack/calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "camera/opencv_yaml.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

constexpr std::array<std::string_view, 3> kUnitNames = {"m", "cm", "mm"};
constexpr std::array<std::string_view, 3> kModelNames = {"none", "brown", "fisheye"};
constexpr std::array<double, 3> kMetresPerUnit = {1.0, 1e-2, 1e-3};

// Plausible baselines for hand tracking. Closer cameras have no parallax; with cameras further
// apart the hand is out of reach. Other values are almost always a wrong unit.
constexpr double kNearestCameras = 0.005;  // metres
constexpr double kFurthestCameras = 2.0;

struct ImageSize {
  int width = 0;
  int height = 0;
};

/// Returns the node under the first name that exists; undefined if none does.
ConfigNode first_of(const ConfigNode& node, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    if (ConfigNode found = node.get(name); found.defined()) return found;
  }
  return {};
}

ConfigNode required(const ConfigNode& node, std::initializer_list<std::string_view> names,
                    std::string_view advice) {
  ConfigNode found = first_of(node, names);
  if (!found.defined()) {
    throw DataError(fmt::format("{}: has no {}; {}", node.where(), *names.begin(), advice));
  }
  return found;
}

template <std::size_t N>
int index_of(const ConfigNode& node, std::string_view key,
             const std::array<std::string_view, N>& names) {
  const auto it = std::find(names.begin(), names.end(), node.scalar());
  if (it == names.end()) {
    throw DataError(fmt::format("{}: {} is '{}'; expected one of {}", node.where(), key,
                                node.scalar().substr(0, 40), fmt::join(names, ", ")));
  }
  return static_cast<int>(it - names.begin());
}

ImageSize read_size(const ConfigNode& node) {
  const ConfigNode width = node.get("image_width");
  const ConfigNode height = node.get("image_height");
  if (width.defined() != height.defined()) {
    throw DataError(fmt::format("{}: gives only one of image_width and image_height; expected both",
                                node.where()));
  }
  if (width.defined()) {
    return {read_count(width, "image_width"), read_count(height, "image_height")};
  }
  if (const ConfigNode size = first_of(node, {"imageSize", "image_size"}); size.defined()) {
    expect_shape(read_matrix(size, "imageSize"), 1, 2);
    return {read_count(size.at(0), "image width"), read_count(size.at(1), "image height")};
  }
  return {};
}

void read_intrinsics(const ConfigNode& node, Camera& camera) {
  const YamlMatrix k = read_matrix(node, "the camera matrix");
  expect_shape(k, 3, 3);
  const auto& v = k.values;
  if (std::abs(v[1]) > 1e-6 * std::abs(v[0])) {
    throw DataError(
        fmt::format("{} has a skew of {:g}; expected 0 (square pixel corners)", k.where, v[1]));
  }
  if (v[3] != 0 || v[6] != 0 || v[7] != 0 || v[8] != 1) {
    throw DataError(
        fmt::format("{} is not of the form fx 0 cx / 0 fy cy / 0 0 1; is it transposed?", k.where));
  }
  camera.fx = v[0];
  camera.fy = v[4];
  camera.cx = v[2];
  camera.cy = v[5];
}

void read_lens(const ConfigNode& node, std::optional<DistortionModel> model, Camera& camera) {
  if (node.defined()) {
    const YamlMatrix d = read_matrix(node, "the distortion");
    if (d.rows != 1 && d.cols != 1) {
      throw DataError(
          fmt::format("{} is {} x {}; expected one row or column", d.where, d.rows, d.cols));
    }
    camera.distortion = d.values;
    // OpenCV pads with zeros: 12 or 14 coefficients equal 8 if thin prism and tilt are unused.
    while (camera.distortion.size() > 8 && camera.distortion.back() == 0) {
      camera.distortion.pop_back();
    }
    if (camera.distortion.size() > 8) {
      throw DataError(
          fmt::format("{} has {} coefficients: thin-prism and tilted-sensor models are "
                      "not supported; calibrate with 5 or 8",
                      d.where, d.values.size()));
    }
  }
  const bool flat = std::all_of(camera.distortion.begin(), camera.distortion.end(),
                                [](double k) { return k == 0; });
  camera.distortion_model = model.value_or(DistortionModel::brown);
  if (!node.defined() || (flat && camera.distortion_model == DistortionModel::none)) {
    camera.distortion_model = DistortionModel::none;
    camera.distortion.clear();
  }
}

void read_pose(const ConfigNode& r_node, const ConfigNode& t_node, double metres_per_unit,
               Camera& camera) {
  const YamlMatrix r = read_matrix(r_node, "R");
  expect_shape(r, 3, 3);
  const YamlMatrix t = read_matrix(t_node, "T");
  expect_shape(t, 3, 1);
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i) rotation(i / 3, i % 3) = r.values[static_cast<std::size_t>(i)];
  camera.camera_from_world.linear() = rotation;
  Camera checked = camera;  // R alone, so that the message gives its line
  checked.width = checked.height = 1;
  checked.fx = checked.fy = 1;
  checked.distortion_model = DistortionModel::none;
  checked.distortion.clear();
  validate(checked, r.where);
  // Files have few digits; orthonormalise the rotation.
  camera.camera_from_world.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  camera.camera_from_world.translation() =
      metres_per_unit * Eigen::Vector3d(t.values[0], t.values[1], t.values[2]);
}

double metres_per_unit(const ConfigNode& file, const CalibrationSettings& settings) {
  std::optional<LengthUnit> units = settings.units;
  if (const ConfigNode said = file.get("units"); said.defined()) {
    const auto in_file = static_cast<LengthUnit>(index_of(said, "units", kUnitNames));
    if (units && *units != in_file) {
      throw DataError(fmt::format("{}: the file is in {}, the scene says `units: {}`; remove one",
                                  said.where(), said.scalar(),
                                  kUnitNames[static_cast<std::size_t>(*units)]));
    }
    units = in_file;
  }
  return settings.scale * metres_per(units.value_or(LengthUnit::m));
}

Camera read_single(const ConfigNode& file, const CalibrationSettings& settings) {
  Camera camera;
  read_intrinsics(file.get("camera_matrix"), camera);
  read_lens(first_of(file, {"distortion_coefficients", "dist_coeffs"}), settings.model, camera);
  return camera;
}

std::vector<Camera> read_stereo(const ConfigNode& file, const CalibrationSettings& settings) {
  std::vector<Camera> cameras(2);
  constexpr std::string_view kNeedsBoth = "expected M1, D1, M2, D2 as stereo_calib writes them";
  read_intrinsics(required(file, {"M1", "K1", "cameraMatrix1"}, kNeedsBoth), cameras[0]);
  read_intrinsics(required(file, {"M2", "K2", "cameraMatrix2"}, kNeedsBoth), cameras[1]);
  read_lens(first_of(file, {"D1", "distCoeffs1"}), settings.model, cameras[0]);
  read_lens(first_of(file, {"D2", "distCoeffs2"}), settings.model, cameras[1]);
  const ConfigNode pose =
      settings.extrinsics.empty() ? file : read_opencv_yaml(settings.extrinsics);
  constexpr std::string_view kTwoFiles =
      "stereo_calib writes R and T to a second file, extrinsics.yml: name it under `extrinsics`";
  read_pose(required(pose, {"R"}, kTwoFiles), required(pose, {"T"}, kTwoFiles),
            metres_per_unit(pose, settings), cameras[1]);
  return cameras;
}

Camera read_listed(const ConfigNode& node, const CalibrationSettings& settings, double metres) {
  constexpr std::array<std::string_view, 9> kKeys = {
      "name", "image_width", "image_height", "model", "K", "D", "R", "T", "imageSize"};
  for (const std::string& key : node.keys()) {
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      throw DataError(fmt::format("{}: a camera has no '{}'; expected {}", node.get(key).where(),
                                  key, fmt::join(kKeys, ", ")));
    }
  }
  Camera camera;
  const ImageSize size = read_size(node);
  camera.width = size.width;
  camera.height = size.height;
  std::optional<DistortionModel> model = settings.model;
  if (const ConfigNode said = node.get("model"); said.defined()) {
    model = static_cast<DistortionModel>(index_of(said, "model", kModelNames));
  }
  read_intrinsics(required(node, {"K"}, "expected K, a 3x3 matrix, for every camera"), camera);
  read_lens(node.get("D"), model, camera);
  if (model.value_or(DistortionModel::none) != DistortionModel::none && !node.get("D").defined()) {
    throw DataError(
        fmt::format("{}: has a lens model but no D; expected its coefficients", node.where()));
  }
  const ConfigNode r = node.get("R");
  const ConfigNode t = node.get("T");
  if (r.defined() != t.defined()) {
    throw DataError(
        fmt::format("{}: gives only one of R and T; expected both or none", node.where()));
  }
  if (r.defined()) read_pose(r, t, metres, camera);
  return camera;
}

std::vector<Camera> read_list(const ConfigNode& file, const CalibrationSettings& settings) {
  const ConfigNode list = file.get("cameras");
  if (!list.is_list() || list.size() == 0) {
    throw DataError(fmt::format("{}: cameras is no list of cameras", list.where()));
  }
  const double metres = metres_per_unit(file, settings);
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < list.size(); ++i) {
    cameras.push_back(read_listed(list.at(i), settings, metres));
  }
  return cameras;
}

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

void apply_size(std::vector<Camera>& cameras, const ConfigNode& file,
                const CalibrationSettings& settings) {
  ImageSize given;
  if (!settings.image_size.empty()) {
    const auto& size = settings.image_size;
    const auto whole = [](double v) { return v >= 1 && v <= 65536 && v == std::floor(v); };
    if (size.size() != 2 || !whole(size[0]) || !whole(size[1])) {
      throw DataError(
          fmt::format("{}: image_size is [{}]; expected [width, height] in whole pixels",
                      settings.file.string(), fmt::join(size, ", ")));
    }
    given = {static_cast<int>(size[0]), static_cast<int>(size[1])};
  }
  const ImageSize common = read_size(file);
  for (Camera& camera : cameras) {
    if (camera.width == 0) {
      camera.width = common.width;
      camera.height = common.height;
    }
    if (given.width != 0) fit_image_size(camera, given.width, given.height, "image_size");
  }
}

}  // namespace

std::span<const std::string_view> enum_names(LengthUnit) { return kUnitNames; }
double metres_per(LengthUnit unit) { return kMetresPerUnit[static_cast<std::size_t>(unit)]; }
std::span<const std::string_view> enum_names(DistortionModel) { return kModelNames; }

std::vector<Camera> load_calibration(const CalibrationSettings& settings) {
  const ConfigNode file = read_opencv_yaml(settings.file);
  std::vector<Camera> cameras;
  if (file.get("cameras").defined()) {
    cameras = read_list(file, settings);
  } else if (first_of(file, {"M1", "K1", "cameraMatrix1", "M2", "K2", "cameraMatrix2"}).defined()) {
    cameras = read_stereo(file, settings);
  } else if (file.get("camera_matrix").defined()) {
    cameras = {read_single(file, settings)};
  } else {
    throw DataError(
        fmt::format("{}: is no calibration; expected `cameras`, M1 and M2 as "
                    "stereo_calib writes them, or camera_matrix. Found: {}",
                    settings.file.string(), fmt::join(file.keys(), ", ")));
  }
  apply_size(cameras, file, settings);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    Camera checked = cameras[i];
    if (checked.width == 0) checked.width = checked.height = 1;  // set with the first image
    validate(checked, fmt::format("{}: camera {}", settings.file.string(), i));
  }
  if (!settings.any_baseline) check_baselines(cameras, settings);
  return cameras;
}

void fit_image_size(Camera& camera, int width, int height, std::string_view where) {
  if (camera.width == 0 && camera.height == 0) {
    camera.width = width;
    camera.height = height;
  }
  if (camera.width == width && camera.height == height) return;
  throw DataError(
      fmt::format("{}: the image is {}x{} pixels, but its camera is calibrated for "
                  "{}x{}; expected the calibration of this resolution",
                  where, width, height, camera.width, camera.height));
}

}  // namespace hypotrack
