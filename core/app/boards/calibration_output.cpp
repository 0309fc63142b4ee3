#include "boards/calibration_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <system_error>

#include "base/text_file.hpp"
#include "camera/lens/field_of_view.hpp"
#include "hypotrack/api/error.hpp"
#include "output/recording/recording_writer.hpp"

namespace hypotrack::app {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

/// Returns how a camera stands to the first one.
std::string standing(const Camera& first, const Camera& other) {
  const Eigen::Isometry3d first_from_other =
      first.camera_from_world * other.camera_from_world.inverse();
  const Eigen::Vector3d at = 1000 * first_from_other.translation();
  const double cosine = std::clamp(first_from_other.linear()(2, 2), -1.0, 1.0);
  return fmt::format("baseline {:.2f} mm ({:+.1f}, {:+.1f}, {:+.1f}), axes {:.2f} degrees apart",
                     at.norm(), at.x(), at.y(), at.z(), kDegrees * std::acos(cosine));
}

/// Returns what a camera sees from edge to edge, with its lens and without.
std::string field_of(const Camera& camera) {
  const FieldOfView seen = field_of_view(camera);
  std::string text = fmt::format("sees {:.1f} x {:.1f} degrees", kDegrees * seen.horizontal,
                                 kDegrees * seen.vertical);
  if (!seen.reaches_edges) text += ", up to where the lens folds inside the picture";
  if (camera.distortion_model == DistortionModel::none) return text;
  Camera pinhole = camera;
  pinhole.distortion_model = DistortionModel::none;
  pinhole.distortion.clear();
  const FieldOfView without = field_of_view(pinhole);
  return text + fmt::format("; without the lens {:.1f} x {:.1f}", kDegrees * without.horizontal,
                            kDegrees * without.vertical);
}

}  // namespace

void check_new_file(const std::filesystem::path& file, bool replace) {
  std::error_code error;
  if (!replace && std::filesystem::exists(file, error)) {
    throw OutputError(
        fmt::format("{}: exists; give another --out, or --force to replace it", file.string()));
  }
}

void write_calibration(const std::filesystem::path& file, const std::vector<Camera>& cameras) {
  write_whole(file, calibration_yaml(cameras));
}

void print_cameras(const std::vector<NamedCamera>& cameras) {
  for (const auto& [name, camera] : cameras) {
    const std::string size =
        camera.width > 0 ? fmt::format("{} x {} px", camera.width, camera.height) : "unknown size";
    fmt::print("{}: {}, focal lengths {:.2f} {:.2f} px, centre {:.2f} {:.2f}", name, size,
               camera.fx, camera.fy, camera.cx, camera.cy);
    fmt::print("\n  lens {}",
               enum_names(DistortionModel())[static_cast<std::size_t>(camera.distortion_model)]);
    if (!camera.distortion.empty()) fmt::print(": {:.5g}", fmt::join(camera.distortion, ", "));
    fmt::print("\n");
    if (camera.width > 0) fmt::print("  {}\n", field_of(camera));
    if (&camera != &cameras.front().camera)
      fmt::print("  {}\n", standing(cameras.front().camera, camera));
  }
}

}  // namespace hypotrack::app
