#include <Eigen/Geometry>
#include <string>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

/// Reads a rotation: a 3x3 matrix, or a vector along the axis, as long as the angle in radians.
Eigen::Matrix3d read_rotation(const ConfigNode& node) {
  const YamlMatrix matrix = read_matrix(node, "rotation");
  if (matrix.values.size() == 3) {
    const Eigen::Vector3d turn(matrix.values[0], matrix.values[1], matrix.values[2]);
    if (turn.norm() == 0) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix();
  }
  expect_shape(matrix, 3, 3);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.values.data());
}

Camera read_table(const ConfigNode& table, const CalibrationSettings& settings, double metres) {
  constexpr std::string_view kAdvice =
      "expected size, matrix, distortions, rotation and translation of a camera";
  Camera camera;
  const ImageSize size = read_size(table);
  camera.width = size.width;
  camera.height = size.height;
  read_intrinsics(required(table, {"matrix"}, kAdvice), camera);
  const ConfigNode fisheye = table.get("fisheye");
  const bool is_fisheye = fisheye.is_scalar() && fisheye.scalar() == "true";
  read_lens(required(table, {"distortions"}, kAdvice),
            is_fisheye ? DistortionModel::fisheye : settings.model, camera);
  const ConfigNode rotation = required(table, {"rotation"}, kAdvice);
  const YamlMatrix t = read_matrix(required(table, {"translation"}, kAdvice), "translation");
  expect_shape(t, 3, 1);
  set_pose(read_rotation(rotation), metres * Eigen::Vector3d(t.values[0], t.values[1], t.values[2]),
           rotation.where() + ": rotation", camera);
  return camera;
}

/// Adds the used keys of a table, the keys that do not describe the camera, and the keys of the
/// recording that would change something.
void add_keys(const std::string& path, const ConfigNode& table, KeyPaths& used,
              KnownButUnused& unused) {
  append_below({path},
               {"name", "matrix", "fisheye", "distortions", "rotation", "translation", "cam_id",
                "port", "error", "grid_count", "exposure", "verified_resolutions"},
               used);
  append(size_keys(path + "/"), used);
  const auto is = [&](std::string_view key, std::string_view value) {
    return !table.get(key).defined() || table.get(key).scalar() == value;
  };
  for (const auto& [key, harmless] : {std::pair{"ignore", "false"}, {"rotation_count", "0"}})
    (is(key, harmless) ? used : unused.paths).push_back(fmt::format("{}/{}", path, key));
}

}  // namespace

std::vector<NamedCamera> read_camera_tables(const ConfigNode& file,
                                            const CalibrationSettings& settings,
                                            std::vector<std::string>& notes) {
  const double metres = metres_per_unit(file, settings);
  const ConfigNode nested = file.get("cameras");
  const ConfigNode& tables = nested.is_map() ? nested : file;
  std::vector<NamedCamera> out;
  KeyPaths used{"units", "metadata/error", "metadata/adjusted"};
  KnownButUnused unused{"of the recording program", {}};
  for (const std::string& key : tables.keys()) {
    const ConfigNode table = tables.get(key);
    if (!table.get("matrix").defined()) continue;  // says something else, as [metadata] does
    const ConfigNode name = table.get("name");
    out.push_back({name.is_scalar() ? name.scalar() : key, read_table(table, settings, metres)});
    add_keys(nested.is_map() ? "cameras/" + key : key, table, used, unused);
  }
  if (!out.empty()) note_unused_keys(file, settings.file.string(), used, {unused}, notes);
  return out;
}

}  // namespace hypotrack::calibration::internal
