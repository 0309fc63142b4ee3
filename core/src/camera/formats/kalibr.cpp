#include <Eigen/Geometry>
#include <string>
#include <utility>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

/// Reads a 4x4 rigid transform.
Eigen::Isometry3d read_transform(const ConfigNode& node, std::string_view name, double metres) {
  return rigid_transform(read_matrix(node, name), metres);
}

Camera read_kalibr_camera(const ConfigNode& node) {
  constexpr std::string_view kAdvice = "expected a camera as Kalibr writes it";
  const ConfigNode model = required(node, {"camera_model"}, kAdvice);
  if (model.scalar() != "pinhole") {
    throw DataError(
        fmt::format("{}: the camera model is '{}'; expected pinhole. Calibrate with "
                    "pinhole-radtan or pinhole-equi",
                    model.where(), model.scalar()));
  }
  Camera camera;
  const YamlMatrix k = read_matrix(required(node, {"intrinsics"}, kAdvice), "intrinsics");
  expect_shape(k, 1, 4);
  camera.fx = k.values[0];
  camera.fy = k.values[1];
  camera.cx = k.values[2];
  camera.cy = k.values[3];
  const ImageSize size = read_size(node);
  camera.width = size.width;
  camera.height = size.height;
  constexpr std::array<std::string_view, 3> kLenses = {"none", "radtan", "equidistant"};
  const ConfigNode lens = required(node, {"distortion_model"}, kAdvice);
  const auto kind = static_cast<DistortionModel>(index_of(lens, "distortion_model", kLenses));
  if (kind != DistortionModel::none)
    read_lens(required(node, {"distortion_coeffs"}, kAdvice), kind, camera);
  return camera;
}

/// Returns the pose of a camera in the frame of the IMU; nothing if the file does not give it.
std::optional<Eigen::Isometry3d> imu_from_camera(const ConfigNode& node, double metres) {
  if (const ConfigNode t = node.get("T_imu_cam"); t.defined())
    return read_transform(t, "T_imu_cam", metres);
  if (const ConfigNode t = node.get("T_cam_imu"); t.defined())
    return read_transform(t, "T_cam_imu", metres).inverse();
  return std::nullopt;
}

/// Returns the motion from the camera before to this one.
Eigen::Isometry3d from_camera_before(const ConfigNode& node, const ConfigNode& before,
                                     double metres) {
  if (const ConfigNode chain = node.get("T_cn_cnm1"); chain.defined())
    return read_transform(chain, "T_cn_cnm1", metres);
  const auto own = imu_from_camera(node, metres), other = imu_from_camera(before, metres);
  if (own && other) return own->inverse() * *other;
  throw DataError(
      fmt::format("{}: has no T_cn_cnm1, the pose from the camera before; expected that, or "
                  "T_imu_cam or T_cam_imu of both. Kalibr writes it when it calibrates the cameras "
                  "together",
                  node.where()));
}

/// Adds one note on what a camchain has beside the cameras that were read.
void note_unused(const ConfigNode& file, const std::string& file_name, std::size_t cameras,
                 std::vector<std::string>& notes) {
  const auto chain_of = [&](std::size_t i) {
    return file.get(fmt::format("cam{}", i)).get("T_cn_cnm1").defined();
  };
  KeyPaths used{"units"};
  KnownButUnused imu{"of the IMU", {}},
      of_none{"no camera is before the first", {"cam0/T_cn_cnm1"}};
  for (std::size_t i = 0; i < cameras; ++i) {
    const std::string name = fmt::format("cam{}", i);
    append_below({name},
                 {"camera_model", "intrinsics", "distortion_model", "distortion_coeffs", "rostopic",
                  "cam_overlaps"},
                 used);
    append(size_keys(name + "/"), used);
    if (i > 0) used.push_back(name + "/T_cn_cnm1");
    const bool needs_imu = (i > 0 && !chain_of(i)) || (i + 1 < cameras && !chain_of(i + 1));
    append_below({name}, {"T_imu_cam", "T_cam_imu"}, needs_imu ? used : imu.paths);
    imu.paths.push_back(name + "/timeshift_cam_imu");
  }
  note_unused_keys(file, file_name, used, {imu, of_none}, notes);
}

}  // namespace

std::vector<NamedCamera> read_kalibr(const ConfigNode& file, const CalibrationSettings& settings,
                                     std::vector<std::string>& notes) {
  const double metres = metres_per_unit(file, settings);
  std::vector<NamedCamera> cameras;
  ConfigNode before;
  while (true) {
    const std::string name = fmt::format("cam{}", cameras.size());
    const ConfigNode node = file.get(name);
    if (!node.defined()) break;
    NamedCamera next{name, read_kalibr_camera(node)};
    if (!cameras.empty())
      next.camera.camera_from_world =
          from_camera_before(node, before, metres) * cameras.back().camera.camera_from_world;
    cameras.push_back(std::move(next));
    before = node;
  }
  note_unused(file, settings.file.string(), cameras.size(), notes);
  return cameras;
}

}  // namespace hypotrack::calibration::internal
