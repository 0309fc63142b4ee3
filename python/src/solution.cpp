#include "hypotrack/api/solution.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "arrays.hpp"
#include "hypotrack/api/text.hpp"
#include "tracker.hpp"

namespace hypotrack::python {
namespace {

py::array landmark_of(const NamedSolution& s, const std::string& name) {
  const auto& names = s.scene->landmark_names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throw py::key_error(
        fmt::format("there is no landmark '{}'{}", name, did_you_mean(name, names)));
  return array_of(Eigen::VectorXd(s.solution.landmarks.col(found - names.begin())));
}

py::dict by_landmark(const NamedSolution& s) {
  py::dict all;
  const auto& names = s.scene->landmark_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    all[py::str(names[i])] =
        array_of(Eigen::VectorXd(s.solution.landmarks.col(static_cast<Eigen::Index>(i))));
  return all;
}

/// Returns a dict of models to values of a list; None where it is shorter.
template <class T>
py::dict by_model(const NamedSolution& s, const std::vector<T>& values) {
  py::dict all;
  for (std::size_t i = 0; i < s.scene->items().size(); ++i)
    all[py::str(s.scene->items()[i].name)] =
        i < values.size() ? py::cast(values[i]) : py::object(py::none());
  return all;
}

py::object sigmas_of(const NamedSolution& s) {
  if (s.solution.sigma.size() == 0) return py::none();
  return array_of(s.solution.sigma);
}

}  // namespace

void add_solution(py::module_& module) {
  py::enum_<Status>(module, "Status", "Status of a frame, or of a model in it.")
      .value("tracked", Status::tracked, "Likely right.")
      .value("uncertain", Status::uncertain, "Perhaps right.")
      .value("lost", Status::lost, "Improbable or out of view.")
      .value("absent", Status::absent, "A search of the whole pictures did not find it.")
      .value("missing", Status::missing, "No usable frame; the state is the last one.");
  py::class_<NamedSolution>(module, "Solution", "The result of one frame.")
      .def_property_readonly("frame", [](const NamedSolution& s) { return s.solution.frame; })
      .def_property_readonly(
          "time", [](const NamedSolution& s) { return s.solution.time; }, "Seconds.")
      .def_property_readonly(
          "status", [](const NamedSolution& s) { return s.solution.status; },
          "The worst Status of the models.")
      .def_property_readonly(
          "statuses", [](const NamedSolution& s) { return by_model(s, s.solution.models); },
          "Status by model.")
      .def_property_readonly(
          "probabilities",
          [](const NamedSolution& s) { return by_model(s, s.solution.probabilities); },
          "Probability, by model, that its pose is right; NaN: unknown.")
      .def_property_readonly(
          "cost", [](const NamedSolution& s) { return s.solution.cost; },
          "NaN if the frame was missing.")
      .def_property_readonly("evaluations",
                             [](const NamedSolution& s) { return s.solution.evaluations; })
      .def_property_readonly(
          "seconds", [](const NamedSolution& s) { return s.solution.seconds; },
          "Wall time from the frame to the result.")
      .def_property_readonly(
          "state", [](const NamedSolution& s) { return array_of(s.solution.state); },
          "State (D,): metres, radians, unit quaternions w x y z.")
      .def_property_readonly(
          "landmarks", [](const NamedSolution& s) { return points_of(s.solution.landmarks); },
          "Landmarks (L, 3) in world axes and metres, in the order of landmark_names.")
      .def_property_readonly(
          "landmark_names", [](const NamedSolution& s) { return s.scene->landmark_names(); },
          "`model.landmark` for each row of landmarks.")
      .def_property_readonly("by_landmark", &by_landmark, "Position (3,) in metres by landmark.")
      .def("__getitem__", &landmark_of, py::arg("landmark"),
           "Returns the position (3,) of a landmark in metres.")
      .def_property_readonly("sigmas", &sigmas_of,
                             "Error expected of each landmark (L,) in metres, or None if "
                             "uncertainty is off.")
      .def_property_readonly(
          "hidden", [](const NamedSolution& s) { return s.solution.hidden; },
          "A bool for each landmark that something hides in both views; empty: none.")
      .def_property_readonly(
          "fault", [](const NamedSolution& s) { return std::string(to_string(s.solution.fault)); },
          "What is wrong with the frame's pictures or time; empty: nothing.")
      .def_readonly("notes", &NamedSolution::notes, "Lines for the user since the frame before.")
      .def(
          "json", [](const NamedSolution& s) { return solution_json(*s.scene, s.solution); },
          "Returns a line of JSON.")
      .def("__repr__", [](const NamedSolution& s) {
        return fmt::format("<hypotrack.Solution of frame {}: {}>", s.solution.frame,
                           to_string(s.solution.status));
      });
}

}  // namespace hypotrack::python
