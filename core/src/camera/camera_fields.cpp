#include "camera/camera_fields.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "camera/calibration_text.hpp"

namespace hypotrack::calibration::internal {
namespace {

constexpr std::array<std::string_view, 3> kUnits = {"m", "cm", "mm"};

/// Reads where the first camera is from a projection matrix.
Eigen::Vector3d read_offset(const ConfigNode& node, double metres) {
  const YamlMatrix matrix = read_matrix(node, "projection_matrix");
  expect_shape(matrix, 3, 4);
  const std::vector<double>& p = matrix.values;
  for (const double focal : {p[0], p[5]}) {
    if (focal > 0) continue;
    throw DataError(
        fmt::format("{} has the focal length {}; expected a positive one", matrix.where, focal));
  }
  if (p[8] != 0 || p[9] != 0 || p[10] != 1 || p[11] != 0) {
    throw DataError(fmt::format("{} has the last row {} {} {} {}; expected 0 0 1 0", matrix.where,
                                p[8], p[9], p[10], p[11]));
  }
  return metres * Eigen::Vector3d(p[3] / p[0], p[7] / p[5], 0);
}

}  // namespace

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

ImageSize read_size(const ConfigNode& node) {
  const ConfigNode width = first_of(node, {"image_width", "image_Width"});
  const ConfigNode height = first_of(node, {"image_height", "image_Height"});
  if (width.defined() != height.defined()) {
    throw DataError(fmt::format("{}: gives only one of image_width and image_height; expected both",
                                node.where()));
  }
  if (width.defined()) {
    return {read_count(width, "image_width"), read_count(height, "image_height")};
  }
  if (const ConfigNode size = first_of(node, {"imageSize", "image_size", "resolution", "size"});
      size.defined()) {
    const YamlMatrix sides = read_matrix(size, "imageSize");
    expect_shape(sides, 1, 2);
    if (size.is_list() && size.size() == 2)
      return {read_count(size.at(0), "image width"), read_count(size.at(1), "image height")};
    const ConfigNode data = size.get("data");  // OpenCV's Python writes sizes as matrices
    if (data.is_list())
      return {read_count(data.at(0), "image width"), read_count(data.at(1), "image height")};
    throw DataError(fmt::format("{}: the image size is no pair of numbers", size.where()));
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
    constexpr std::size_t kPlain = 8, kPrisms = 12, kTilt = 14;
    std::vector<double>& k = camera.distortion;
    while (k.size() > kPlain && k.back() == 0) k.pop_back();
    if (k.size() > kTilt) {
      throw DataError(fmt::format("{} has {} coefficients; expected 4, 5, 8, 12 or 14", d.where,
                                  d.values.size()));
    }
    if (k.size() > kPlain) k.resize(k.size() > kPrisms ? kTilt : kPrisms);
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
  set_pose(rotation, metres_per_unit * Eigen::Vector3d(t.values[0], t.values[1], t.values[2]),
           r.where, camera);
}

void set_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
              std::string_view where, Camera& camera) {
  Camera checked;  // R alone, so that the message gives its line
  checked.camera_from_world.linear() = rotation;
  checked.width = checked.height = 1;
  checked.fx = checked.fy = 1;
  validate(checked, where);
  // Files have few digits; orthonormalise the rotation.
  camera.camera_from_world.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  camera.camera_from_world.translation() = translation;
}

Eigen::Isometry3d rigid_transform(const YamlMatrix& matrix, double metres_per_unit) {
  expect_shape(matrix, 4, 4);
  const Eigen::Matrix4d values =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix.values.data());
  if (values.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw DataError(fmt::format("{} has another last row than 0 0 0 1", matrix.where));
  Camera holder;
  set_pose(values.topLeftCorner<3, 3>(), metres_per_unit * values.topRightCorner<3, 1>(),
           matrix.where, holder);
  return holder.camera_from_world;
}

Rectified read_rectified(const ConfigNode& rotation, const ConfigNode& projection,
                         double metres_per_unit) {
  Rectified out;
  if (rotation.defined()) {
    const YamlMatrix matrix = read_matrix(rotation, "rectification_matrix");
    expect_shape(matrix, 3, 3);
    Camera holder;
    set_pose(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.values.data()),
             Eigen::Vector3d::Zero(), matrix.where, holder);
    out.rectified_from_camera = holder.camera_from_world.linear();
  }
  if (projection.defined()) out.offset = read_offset(projection, metres_per_unit);
  return out;
}

Eigen::Isometry3d second_from_first(const Rectified& first, const Rectified& second) {
  const Eigen::Matrix3d camera_from_rectified = second.rectified_from_camera.transpose();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = camera_from_rectified * first.rectified_from_camera;
  out.translation() = camera_from_rectified * (second.offset - first.offset);
  return out;
}

double metres_per_unit(const ConfigNode& file, const CalibrationSettings& settings,
                       LengthUnit usual) {
  std::optional<LengthUnit> units = settings.units;
  if (const ConfigNode said = file.get("units"); said.defined()) {
    const auto in_file = static_cast<LengthUnit>(index_of(said, "units", kUnits));
    if (units && *units != in_file) {
      throw DataError(fmt::format("{}: the file is in {}, the scene says `units: {}`; remove one",
                                  said.where(), said.scalar(),
                                  kUnits[static_cast<std::size_t>(*units)]));
    }
    units = in_file;
  }
  return settings.scale * metres_per(units.value_or(usual));
}

}  // namespace hypotrack::calibration::internal
