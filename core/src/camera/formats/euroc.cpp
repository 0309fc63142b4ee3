#include <Eigen/Geometry>
#include <string>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

struct Sensor {
  Camera camera;
  Eigen::Isometry3d body_from_camera;
};

Sensor read_sensor(const ConfigNode& file, const std::string& file_name, double metres,
                   std::vector<std::string>& notes) {
  constexpr std::string_view kAdvice = "expected a sensor.yaml of a camera, as EuRoC has it";
  constexpr std::array<std::string_view, 1> kModels = {"pinhole"};
  constexpr std::array<std::string_view, 3> kLenses = {"none", "radial-tangential", "equidistant"};
  index_of(required(file, {"camera_model"}, kAdvice), "camera_model", kModels);
  Sensor out;
  const YamlMatrix k = read_matrix(required(file, {"intrinsics"}, kAdvice), "intrinsics");
  expect_shape(k, 1, 4);
  out.camera.fx = k.values[0];
  out.camera.fy = k.values[1];
  out.camera.cx = k.values[2];
  out.camera.cy = k.values[3];
  const ImageSize size = read_size(file);
  out.camera.width = size.width;
  out.camera.height = size.height;
  const auto lens = static_cast<DistortionModel>(
      index_of(required(file, {"distortion_model"}, kAdvice), "distortion_model", kLenses));
  if (lens != DistortionModel::none)
    read_lens(required(file, {"distortion_coefficients"}, kAdvice), lens, out.camera);
  out.body_from_camera = rigid_transform(read_matrix(file.get("T_BS"), "T_BS"), metres);
  KeyPaths used{"sensor_type",  "comment",    "rate_hz",          "T_BS",
                "camera_model", "intrinsics", "distortion_model", "distortion_coefficients",
                "units"};
  append(size_keys(""), used);
  note_unused_keys(file, file_name, used, {}, notes);
  return out;
}

}  // namespace

bool is_euroc(const ConfigNode& file) {
  return file.get("T_BS").defined() && file.get("intrinsics").defined();
}

std::vector<NamedCamera> read_euroc(const ConfigNode& file, const CalibrationSettings& settings,
                                    std::vector<std::string>& notes) {
  const double metres = metres_per_unit(file, settings);
  const Sensor first = read_sensor(file, settings.file.string(), metres, notes);
  if (settings.second.empty()) return {{"left", first.camera}};
  const ConfigNode other = read_calibration_text(settings.second);
  if (!is_euroc(other)) {
    throw DataError(
        fmt::format("{}: is no sensor.yaml of a camera, as {} is; expected that of the "
                    "second camera",
                    settings.second.string(), settings.file.string()));
  }
  Sensor second = read_sensor(other, settings.second.string(), metres, notes);
  second.camera.camera_from_world = second.body_from_camera.inverse() * first.body_from_camera;
  return {{"left", first.camera}, {"right", second.camera}};
}

}  // namespace hypotrack::calibration::internal
