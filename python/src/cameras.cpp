#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>

#include "arrays.hpp"
#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack::python {
namespace {

Eigen::Isometry3d pose_of(const Numbers& array, const char* what) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.matrix() = matrix_of(array, 4, 4, what);
  if (!pose.matrix().row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)))
    throw DataError(fmt::format("{}: the last row is not 0 0 0 1", what));
  return pose;
}

DistortionModel model_of(const std::string& name, std::size_t coefficients) {
  if (name.empty()) return coefficients == 0 ? DistortionModel::none : DistortionModel::brown;
  const auto names = enum_names(DistortionModel{});
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<DistortionModel>(i);
  throw DataError(fmt::format("model: found '{}', expected none, brown or fisheye", name));
}

/// Returns the camera with a size to check it by: the principal point is about the middle.
Camera with_a_size(Camera camera) {
  if (camera.width != 0 || camera.height != 0) return camera;
  const auto about = [](double centre) {
    return std::isfinite(centre) ? static_cast<int>(std::clamp(2 * std::abs(centre), 64.0, 65536.0))
                                 : 64;
  };
  camera.width = about(camera.cx);
  camera.height = about(camera.cy);
  return camera;
}

/// Returns the coefficients of an array of one axis, or of the row or column that OpenCV gives.
std::vector<double> coefficients_of(const Numbers& array) {
  py::ssize_t longest = 0;
  for (py::ssize_t i = 0; i < array.ndim(); ++i) longest = std::max(longest, array.shape(i));
  if (array.ndim() < 1 || longest != array.size()) array.refuse("distortion", "(K,)");
  return {array.data(), array.data() + array.size()};
}

Camera camera_of(const Numbers& matrix, std::pair<int, int> size, const Numbers& coefficients,
                 const std::string& model, const py::object& camera_from_world) {
  const Eigen::Matrix3d k = matrix_of(matrix, 3, 3, "matrix");
  Camera camera;
  camera.width = size.first;
  camera.height = size.second;
  camera.fx = k(0, 0);
  camera.fy = k(1, 1);
  camera.cx = k(0, 2);
  camera.cy = k(1, 2);
  if (k(0, 1) != 0 || k(1, 0) != 0 || k(2, 0) != 0 || k(2, 1) != 0 || k(2, 2) != 1)
    throw DataError("matrix: expected [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], without skew");
  camera.distortion = coefficients_of(coefficients);
  camera.distortion_model = model_of(model, camera.distortion.size());
  if (!camera_from_world.is_none())
    camera.camera_from_world = pose_of(numbers_of(camera_from_world), "camera_from_world");
  validate(with_a_size(camera), "camera");
  return camera;
}

py::array matrix_of_camera(const Camera& camera) {
  Eigen::Matrix3d k;
  k << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  return rows_of<double>(Eigen::MatrixXd(k.transpose()));
}

py::array project_all(const Camera& camera, const Numbers& points) {
  const bool one = points.ndim() == 1;
  const ColumnsMap columns = columns_of(points, 3, "points");
  Eigen::MatrixXd pixels(2, columns.cols());
  for (Eigen::Index i = 0; i < columns.cols(); ++i) pixels.col(i) = project(camera, columns.col(i));
  return rows_of<double>(pixels, one);
}

template <class T>
T value_as(const py::handle& value, const std::string& name) {
  try {
    return py::cast<T>(value);
  } catch (const py::cast_error&) {
    throw ConfigError(fmt::format("load_calibration: {}: found {}, which is of another type", name,
                                  py::cast<std::string>(py::repr(value))));
  }
}

std::vector<Camera> load(const std::filesystem::path& file, const py::kwargs& settings) {
  CalibrationSettings from;
  from.file = file;
  for (const auto& [key, value] : settings) {
    const auto name = py::cast<std::string>(key);
    if (name == "second")
      from.second = value_as<std::filesystem::path>(value, name);
    else if (name == "extrinsics")
      from.extrinsics = value_as<std::filesystem::path>(value, name);
    else if (name == "cameras")
      from.cameras = value_as<std::vector<std::string>>(value, name);
    else if (name == "scale")
      from.scale = value_as<double>(value, name);
    else if (name == "size")
      from.image_size = value_as<std::vector<double>>(value, name);
    else
      throw ConfigError(fmt::format(
          "load_calibration: unknown argument '{}'; expected second, extrinsics, cameras, scale or "
          "size",
          name));
  }
  return without_gil([&] { return load_calibration(from); });
}

}  // namespace

void add_cameras(py::module_& module) {
  py::class_<Camera>(module, "Camera",
                     "A calibrated camera with the axes of OpenCV: x right, y down, z forward.")
      .def(
          py::init(&camera_of), py::arg("matrix"), py::arg("size") = std::pair(0, 0),
          py::arg("distortion") = py::tuple(), py::arg("model") = "",
          py::arg("camera_from_world") = py::none(),
          "Makes a camera of its matrix (3, 3) and (width, height) in pixels; (0, 0): those of its "
          "first picture. `distortion` has coefficients in the order of OpenCV, `model` is none, "
          "brown or fisheye, `camera_from_world` (4, 4) is in metres.")
      .def_property_readonly(
          "size", [](const Camera& c) { return py::make_tuple(c.width, c.height); },
          "Width and height in pixels; zeros: unknown.")
      .def_property_readonly("matrix", &matrix_of_camera, "The camera matrix (3, 3).")
      .def_property_readonly(
          "distortion", [](const Camera& c) { return c.distortion; },
          "Distortion coefficients in the order of OpenCV.")
      .def_property_readonly(
          "model",
          [](const Camera& c) {
            return std::string(
                enum_names(DistortionModel{})[static_cast<std::size_t>(c.distortion_model)]);
          },
          "Lens model: none, brown or fisheye.")
      .def_property_readonly(
          "camera_from_world",
          [](const Camera& c) {
            return rows_of<double>(Eigen::MatrixXd(c.camera_from_world.matrix().transpose()));
          },
          "Pose (4, 4), which maps world points to the camera's axes; metres.")
      .def("project", &project_all, py::arg("points"),
           "Returns the pixels (N, 2) of world points (N, 3) in metres, with lens distortion; NaN "
           "behind the camera.")
      .def("__repr__", [](const Camera& c) {
        return fmt::format("<hypotrack.Camera {}x{}, fx {:.1f}>", c.width, c.height, c.fx);
      });
  module.def(
      "load_calibration", &load, py::arg("file"),
      "Reads the cameras of a calibration file, in any format that hypotrack reads. Keyword "
      "arguments: second, extrinsics (files), cameras (names), scale, size (width, height).");
}

}  // namespace hypotrack::python
