#include <Eigen/Geometry>

#include "camera/calibration_text.hpp"
#include "camera/camera_fields.hpp"
#include "camera/formats/formats.hpp"

namespace hypotrack::calibration::internal {
namespace {

/// A camera of ROS, and how its pictures are rectified.
struct RosCamera {
  NamedCamera named;
  Eigen::Matrix3d rectified_from_camera = Eigen::Matrix3d::Identity();
  double offset = 0;  ///< metres along x from this to the first camera, in the rectified frame
};

void read_ros_lens(const ConfigNode& file, Camera& camera) {
  constexpr std::array<std::string_view, 4> kNames = {"plumb_bob", "rational_polynomial",
                                                      "equidistant", "none"};
  constexpr std::array<DistortionModel, 4> kKinds = {DistortionModel::brown, DistortionModel::brown,
                                                     DistortionModel::fisheye,
                                                     DistortionModel::none};
  const ConfigNode model = file.get("distortion_model");
  const auto kind = kKinds[static_cast<std::size_t>(index_of(model, "distortion_model", kNames))];
  if (kind == DistortionModel::none) return;
  read_lens(required(file, {"distortion_coefficients"}, "expected a camera_info of ROS"), kind,
            camera);
}

RosCamera read_ros_camera(const ConfigNode& file, const CalibrationSettings& settings,
                          std::string_view usual_name) {
  RosCamera out;
  Camera& camera = out.named.camera;
  const ConfigNode name = file.get("camera_name");
  out.named.name = name.is_scalar() && !name.scalar().empty() ? name.scalar() : usual_name;
  const ImageSize size = read_size(file);
  camera.width = size.width;
  camera.height = size.height;
  read_intrinsics(file.get("camera_matrix"), camera);
  read_ros_lens(file, camera);
  if (const ConfigNode r = file.get("rectification_matrix"); r.defined()) {
    const YamlMatrix matrix = read_matrix(r, "rectification_matrix");
    expect_shape(matrix, 3, 3);
    Camera holder;
    set_pose(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.values.data()),
             Eigen::Vector3d::Zero(), matrix.where, holder);
    out.rectified_from_camera = holder.camera_from_world.linear();
  }
  if (const ConfigNode p = file.get("projection_matrix"); p.defined()) {
    const YamlMatrix matrix = read_matrix(p, "projection_matrix");
    expect_shape(matrix, 3, 4);
    if (!(matrix.values[0] > 0)) {
      throw DataError(fmt::format("{} has the focal length {}; expected a positive one",
                                  matrix.where, matrix.values[0]));
    }
    out.offset = metres_per_unit(file, settings) * matrix.values[3] / matrix.values[0];
  }
  return out;
}

}  // namespace

bool is_ros(const ConfigNode& file) {
  return file.get("camera_matrix").defined() && file.get("distortion_model").defined();
}

std::vector<NamedCamera> read_ros(const ConfigNode& file, const CalibrationSettings& settings) {
  const RosCamera first = read_ros_camera(file, settings, "left");
  if (settings.second.empty()) return {first.named};
  const ConfigNode other = read_calibration_text(settings.second);
  if (!is_ros(other)) {
    throw DataError(
        fmt::format("{}: is no camera_info of ROS, as {} is; expected that of the "
                    "second camera",
                    settings.second.string(), settings.file.string()));
  }
  const RosCamera second = read_ros_camera(other, settings, "right");
  if (first.offset == second.offset) {
    throw DataError(
        fmt::format("{}: the projection matrices of both cameras say that they are at one place "
                    "(row 1, column 4); expected cameras that were calibrated together",
                    settings.second.string()));
  }
  std::vector<NamedCamera> out{first.named, second.named};
  const Eigen::Matrix3d camera_from_rectified = second.rectified_from_camera.transpose();
  Eigen::Isometry3d& pose = out[1].camera.camera_from_world;
  pose.linear() = camera_from_rectified * first.rectified_from_camera;
  pose.translation() = camera_from_rectified * Eigen::Vector3d(second.offset - first.offset, 0, 0);
  return out;
}

}  // namespace hypotrack::calibration::internal
