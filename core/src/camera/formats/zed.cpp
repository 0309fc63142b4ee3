#include <Eigen/Geometry>
#include <string>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"

namespace hypotrack::calibration::internal {
namespace {

/// A resolution of a ZED's pictures.
struct Resolution {
  std::string_view name;
  int width, height;
};
constexpr std::array<Resolution, 6> kResolutions = {{{"2K", 2208, 1242},
                                                     {"FHD", 1920, 1080},
                                                     {"FHD1200", 1920, 1200},
                                                     {"HD", 1280, 720},
                                                     {"SVGA", 960, 600},
                                                     {"VGA", 672, 376}}};

double number_of(const ConfigNode& section, std::string_view key) {
  const ConfigNode node = section.get(key);
  if (!node.defined()) {
    throw DataError(
        fmt::format("{}: has no {}; expected a ZED's factory calibration", section.where(), key));
  }
  return read_number(node, key);
}

/// Returns the number of a key for one resolution, or else that of the key, or else 0.
double number_for(const ConfigNode& section, std::string_view key, const Resolution& size) {
  const std::string own = fmt::format("{}_{}", key, size.name);
  if (section.get(own).defined()) return number_of(section, own);
  return section.get(key).defined() ? number_of(section, key) : 0;
}

Camera read_zed_camera(const ConfigNode& section, const Resolution& size) {
  Camera camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = number_of(section, "fx");
  camera.fy = number_of(section, "fy");
  camera.cx = number_of(section, "cx");
  camera.cy = number_of(section, "cy");
  camera.distortion_model = DistortionModel::brown;
  for (const char* key : {"k1", "k2", "p1", "p2", "k3"})
    camera.distortion.push_back(section.get(key).defined() ? number_of(section, key) : 0);
  return camera;
}

/// Returns the pose of the right camera: a turn about (RX, CV, RZ) by that vector's length, as
/// Rodrigues' formula takes it, and the place (Baseline, TY, TZ) in the right camera's axes.
Eigen::Isometry3d right_from_left(const ConfigNode& pair, const Resolution& size, double metres) {
  const Eigen::Vector3d turn(number_for(pair, "RX", size), number_for(pair, "CV", size),
                             number_for(pair, "RZ", size));
  const Eigen::Vector3d place(number_of(pair, "Baseline"), number_for(pair, "TY", size),
                              number_for(pair, "TZ", size));
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  if (turn.norm() > 0) out.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix();
  out.translation() = -metres * place;
  return out;
}

}  // namespace

bool is_zed(const ConfigNode& file) {
  return file.get("STEREO").is_map() && std::ranges::any_of(kResolutions, [&](const auto& size) {
           return file.get(fmt::format("LEFT_CAM_{}", size.name)).is_map();
         });
}

std::vector<NamedCamera> read_zed(const ConfigNode& file, const CalibrationSettings& settings,
                                  const ImageSize& pictures) {
  std::string known;
  for (const Resolution& size : kResolutions) {
    const ConfigNode left = file.get(fmt::format("LEFT_CAM_{}", size.name));
    const ConfigNode right = file.get(fmt::format("RIGHT_CAM_{}", size.name));
    if (!left.is_map() || !right.is_map()) continue;
    known += fmt::format("{}{} x {}", known.empty() ? "" : ", ", size.width, size.height);
    if (size.width != pictures.width || size.height != pictures.height) continue;
    std::vector<NamedCamera> out{{"left", read_zed_camera(left, size)},
                                 {"right", read_zed_camera(right, size)}};
    out[1].camera.camera_from_world =
        right_from_left(file.get("STEREO"), size, metres_per_unit(file, settings, LengthUnit::mm));
    return out;
  }
  if (pictures.width == 0) {
    throw DataError(
        fmt::format("{}: has cameras for pictures of {}; choose one with `image_size: [width, "
                    "height]`",
                    settings.file.string(), known));
  }
  throw DataError(fmt::format("{}: has no cameras for pictures of {} x {}; expected {}",
                              settings.file.string(), pictures.width, pictures.height, known));
}

}  // namespace hypotrack::calibration::internal
