#include <Eigen/Geometry>
#include <string>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"
#include "camera/formats/unused_keys.hpp"

namespace hypotrack::calibration::internal {
namespace {

// Keys of files that camera_calibration writes, and those of messages of ROS 1 and 2.
using Names = std::initializer_list<std::string_view>;
const Names kMatrix = {"camera_matrix", "K", "k"};
const Names kDistortion = {"distortion_coefficients", "D", "d"};
const Names kRectification = {"rectification_matrix", "R", "r"};
const Names kProjection = {"projection_matrix", "P", "p"};

/// A camera of ROS, and how its pictures are rectified.
struct RosCamera {
  NamedCamera named;
  Rectified rectified;
};

/// Returns whether a node is a list or a matrix without numbers.
bool is_empty(const ConfigNode& node) {
  if (node.is_list()) return node.size() == 0;
  const ConfigNode data = node.get("data");
  return data.is_list() && data.size() == 0 &&
         (node.get("rows").scalar() == "0" || node.get("cols").scalar() == "0");
}

void read_ros_lens(const ConfigNode& file, Camera& camera) {
  constexpr std::array<std::string_view, 4> kNames = {"plumb_bob", "rational_polynomial",
                                                      "equidistant", "none"};
  constexpr std::array<DistortionModel, 4> kKinds = {DistortionModel::brown, DistortionModel::brown,
                                                     DistortionModel::fisheye,
                                                     DistortionModel::none};
  const ConfigNode model = file.get("distortion_model");
  const auto kind = kKinds[static_cast<std::size_t>(index_of(model, "distortion_model", kNames))];
  const ConfigNode coefficients = first_of(file, kDistortion);
  const bool empty = is_empty(coefficients);
  if (kind == DistortionModel::none && (empty || !coefficients.defined())) return;
  if (empty && model.scalar() == "plumb_bob") return;  // of rectified pictures
  if (empty) {
    throw DataError(
        fmt::format("{}: the distortion is empty, and the distortion_model is {}; expected its "
                    "coefficients, or plumb_bob or none for pictures without distortion",
                    coefficients.where(), model.scalar()));
  }
  read_lens(required(file, kDistortion, "expected a camera_info of ROS"), kind, camera);
}

/// Reads image_width and image_height, or the width and height of a message.
ImageSize read_ros_size(const ConfigNode& file) {
  const ImageSize size = read_size(file);
  const ConfigNode width = file.get("width"), height = file.get("height");
  if (size.width != 0 || (!width.defined() && !height.defined())) return size;
  if (!width.defined() || !height.defined()) {
    throw DataError(
        fmt::format("{}: gives only one of width and height; expected both", file.where()));
  }
  return {read_count(width, "width"), read_count(height, "height")};
}

/// Throws DataError if a message is about pictures that were made smaller or cut out. Its numbers
/// are of the whole pictures.
void expect_whole_pictures(const ConfigNode& file, const ImageSize& size) {
  for (const char* key : {"binning_x", "binning_y"}) {
    const ConfigNode binning = file.get(key);
    if (!binning.defined() || read_number(binning, key) <= 1) continue;
    throw DataError(
        fmt::format("{}: {} is {}; expected 0 or 1: take the camera_info of pictures without "
                    "binning",
                    binning.where(), key, binning.scalar()));
  }
  const ConfigNode roi = file.get("roi");
  const auto is = [&](std::string_view key, double other) {
    const ConfigNode node = roi.get(key);
    if (!node.defined()) return true;
    const double value = read_number(node, key);
    return value == 0 || value == other;
  };
  if (is("x_offset", 0) && is("y_offset", 0) && is("width", size.width) &&
      is("height", size.height))
    return;
  throw DataError(
      fmt::format("{}: roi is a part of the pictures; expected zeros, or all of {} x {}: take the "
                  "camera_info of whole pictures",
                  roi.where(), size.width, size.height));
}

/// Reads a camera of which only the rectified pictures are known: its projection matrix is given,
/// its camera matrix is missing or full of zeros.
void read_rectified_camera(const ConfigNode& file, double metres, RosCamera& out,
                           std::vector<std::string>& notes) {
  const YamlMatrix projection = read_matrix(
      required(file, kProjection, "expected a camera_info of ROS"), "projection_matrix");
  out.rectified = read_rectified({}, first_of(file, kProjection), metres);
  Camera& camera = out.named.camera;
  camera.fx = projection.values[0];
  camera.cx = projection.values[2];
  camera.fy = projection.values[5];
  camera.cy = projection.values[6];
  notes.push_back(
      fmt::format("{}: has no camera matrix; its projection matrix is read, which is of rectified "
                  "pictures without a lens: give these",
                  file.where()));
}

RosCamera read_ros_camera(const ConfigNode& file, const CalibrationSettings& settings,
                          std::string_view usual_name, std::vector<std::string>& notes) {
  RosCamera out;
  Camera& camera = out.named.camera;
  const ConfigNode name = file.get("camera_name");
  out.named.name = name.is_scalar() && !name.scalar().empty() ? name.scalar() : usual_name;
  const ImageSize size = read_ros_size(file);
  expect_whole_pictures(file, size);
  camera.width = size.width;
  camera.height = size.height;
  const double metres = metres_per_unit(file, settings);
  if (is_unknown_matrix(first_of(file, kMatrix), "camera_matrix")) {
    read_rectified_camera(file, metres, out, notes);
    return out;
  }
  read_intrinsics(first_of(file, kMatrix), camera);
  read_ros_lens(file, camera);
  out.rectified =
      read_rectified(first_of(file, kRectification), first_of(file, kProjection), metres);
  return out;
}

/// Adds one note on all keys of a file that are not used.
void note_unused(const ConfigNode& file, const std::string& file_name,
                 std::vector<std::string>& notes) {
  KeyPaths used{"header/**", "camera_name", "distortion_model", "width",        "height",
                "units",     "binning_x",   "binning_y",        "roi/x_offset", "roi/y_offset",
                "roi/width", "roi/height",  "roi/do_rectify"};
  for (const Names& names : {kMatrix, kDistortion, kRectification, kProjection})
    used.insert(used.end(), names.begin(), names.end());
  append(size_keys(""), used);
  note_unused_keys(file, file_name, used, {}, notes);
}

}  // namespace

bool is_ros(const ConfigNode& file) {
  return (first_of(file, kMatrix).defined() || first_of(file, kProjection).defined()) &&
         file.get("distortion_model").defined();
}

std::vector<NamedCamera> read_ros(const ConfigNode& file, const CalibrationSettings& settings,
                                  std::vector<std::string>& notes) {
  const RosCamera first = read_ros_camera(file, settings, "left", notes);
  note_unused(file, settings.file.string(), notes);
  if (settings.second.empty()) return {first.named};
  const ConfigNode other = read_calibration_text(settings.second);
  if (!is_ros(other)) {
    throw DataError(
        fmt::format("{}: is no camera_info of ROS, as {} is; expected that of the "
                    "second camera",
                    settings.second.string(), settings.file.string()));
  }
  const RosCamera second = read_ros_camera(other, settings, "right", notes);
  note_unused(other, settings.second.string(), notes);
  const Eigen::Vector3d offset = second.rectified.offset - first.rectified.offset;
  if (offset == Eigen::Vector3d::Zero()) {
    throw DataError(
        fmt::format("{}: the projection matrices of both cameras say that they are at one place "
                    "(rows 1 and 2, column 4); expected cameras that were calibrated together",
                    settings.second.string()));
  }
  std::vector<NamedCamera> out{first.named, second.named};
  out[1].camera.camera_from_world = second_from_first(first.rectified, second.rectified);
  return out;
}

}  // namespace hypotrack::calibration::internal
