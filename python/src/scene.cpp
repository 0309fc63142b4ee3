#include "hypotrack/api/scene.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "arrays.hpp"
#include "common.hpp"
#include "hypotrack/api/pose.hpp"

namespace hypotrack::python {
namespace {

const char* to_text(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::position:
      return "position";
    case ParameterKind::quaternion:
      return "quaternion";
    case ParameterKind::angle:
      return "angle";
    case ParameterKind::length:
      return "length";
  }
  return "";
}

py::list parameters_of(const Scene& scene) {
  py::list all;
  for (const Parameter& p : scene.parameters()) {
    py::dict one;
    one["name"] = p.name;
    one["kind"] = to_text(p.kind);
    one["lower"] = p.lower;
    one["upper"] = p.upper;
    one["rest"] = p.rest;
    all.append(one);
  }
  return all;
}

const Scene::Item& item_of(const Scene& scene, const std::string& name) {
  const auto found =
      std::ranges::find_if(scene.items(), [&](const auto& item) { return item.name == name; });
  if (found == scene.items().end())
    throw ConfigError(fmt::format("the scene has no model '{}'", name));
  return *found;
}

std::vector<std::string> models_of(const Scene& scene) {
  std::vector<std::string> names;
  for (const Scene::Item& item : scene.items()) names.push_back(item.name);
  return names;
}

/// Returns landmarks (L, 3) of a state (D), or (N, L, 3) of states (N, D).
py::array landmarks_of(const Scene& scene, const Numbers& states) {
  const ColumnsMap columns = columns_of(states, scene.dimension(), "states");
  const auto count = static_cast<Eigen::Index>(scene.landmark_names().size());
  Eigen::MatrixXd all(3 * count, columns.cols());
  for (Eigen::Index k = 0; k < columns.cols(); ++k)
    all.col(k) = scene.landmarks(columns.col(k)).reshaped();
  std::vector<py::ssize_t> shape{count, 3};
  if (states.ndim() == 2) shape.insert(shape.begin(), columns.cols());
  return py::array_t<double>(shape, all.data());
}

}  // namespace

void add_scene(py::module_& module) {
  py::class_<Scene, std::shared_ptr<Scene>>(module, "Scene",
                                            "The tracked models and the state that poses them.")
      .def_property_readonly("models", &models_of,
                             "Names of the models, in the order of the state.")
      .def_property_readonly("dimension", &Scene::dimension, "Length D of a state.")
      .def_property_readonly(
          "parameters", &parameters_of,
          "A dict for each number of the state: name, kind (position and length in metres, "
          "quaternion w x y z, angle in radians), lower, upper, rest.")
      .def_property_readonly(
          "landmark_names", [](const Scene& s) { return s.landmark_names(); },
          "Names of the L landmarks: `model.landmark`.")
      .def(
          "slice",
          [](const Scene& scene, const std::string& model) {
            const Scene::Item& item = item_of(scene, model);
            return py::slice(item.offset, item.offset + item.model->dimension(), 1);
          },
          py::arg("model"), "Returns the slice of a state that belongs to a model.")
      .def(
          "rest_state", [](const Scene& s) { return array_of(s.rest_state()); },
          "Returns the state (D,) at rest.")
      .def("landmarks", &landmarks_of, py::arg("states"),
           "Returns the landmarks (L, 3) of a state (D,), or (N, L, 3) of states (N, D), in world "
           "axes and metres.")
      .def(
          "normalize",
          [](const Scene& scene, const Numbers& array) {
            Eigen::VectorXd state = vector_of(array, scene.dimension(), "state");
            scene.normalize(state);
            return array_of(state);
          },
          py::arg("state"), "Returns the state (D,) with unit quaternions.")
      .def(
          "pose",
          [](const Scene& scene, const py::dict& poses, const py::object& base) {
            const Eigen::VectorXd from =
                base.is_none() ? scene.rest_state()
                               : vector_of(numbers_of(base), scene.dimension(), "base");
            return array_of(read_pose(value_of(poses, "pose").document("pose"), scene, from));
          },
          py::arg("poses"), py::arg("base") = py::none(),
          "Returns the state (D,) `base`, or that at rest, with poses as `init.pose` writes them: "
          "{model: {position_mm, rotation_deg, angles_deg}}.")
      .def(
          "mesh",
          [](const Scene& scene, const std::string& model) {
            const Mesh& mesh = item_of(scene, model).model->data().mesh;
            return py::make_tuple(rows_of<float>(mesh.vertices), rows_of<int>(mesh.triangles));
          },
          py::arg("model"),
          "Returns the vertices (V, 3) of a model at its bind pose, in metres, and its triangles "
          "(T, 3).");
}

}  // namespace hypotrack::python
