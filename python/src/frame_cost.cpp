#include "frame_cost.hpp"

#include <pybind11/stl.h>

#include "arrays.hpp"

namespace hypotrack::python {
namespace {

py::object costs_of(PythonFrameCost& self, const Numbers& states) {
  const ColumnsMap columns = columns_of(states, self.dimension(), "states");
  const Eigen::VectorXd costs = self.call([&](FrameCost& cost) { return cost.costs(columns); });
  if (states.ndim() == 1) return py::float_(costs[0]);
  return array_of(costs);
}

py::dict terms_of(PythonFrameCost& self, const Numbers& states) {
  const ColumnsMap columns = columns_of(states, self.dimension(), "states");
  const Eigen::MatrixXd terms = self.call([&](FrameCost& cost) { return cost.terms(columns); });
  py::dict all;
  const auto& names = self.cost().term_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string key = names[i];
    for (int k = 2; all.contains(key); ++k) key = names[i] + "_" + std::to_string(k);
    all[py::str(key)] = array_of(Eigen::VectorXd(terms.row(static_cast<Eigen::Index>(i))));
  }
  return all;
}

py::array residuals_of(PythonFrameCost& self, const Numbers& states) {
  const ColumnsMap columns = columns_of(states, self.dimension(), "states");
  return rows_of<float>(self.call([&](FrameCost& cost) { return cost.residuals(columns); }),
                        states.ndim() == 1);
}

py::array jacobian_of(PythonFrameCost& self, const Numbers& state, const Numbers& steps) {
  const Eigen::VectorXd at = finite_vector_of(state, self.dimension(), "state"),
                        by = finite_vector_of(steps, self.dimension(), "steps");
  // Transposed without a copy of rows: columns of the matrix are rows of its transpose.
  const py::array columns =
      rows_of<float>(self.call([&](FrameCost& cost) { return cost.jacobian(at, by); }));
  return columns.attr("T");
}

py::tuple equations_of(PythonFrameCost& self, const Numbers& state, const Numbers& steps,
                       double blur) {
  const Eigen::VectorXd at = finite_vector_of(state, self.dimension(), "state"),
                        by = finite_vector_of(steps, self.dimension(), "steps");
  check_blur(blur);
  const NormalEquations found =
      self.call([&](FrameCost& cost) { return cost.linearize(at, by, blur); });
  return py::make_tuple(rows_of<double>(found.a), array_of(found.g));
}

}  // namespace

void add_frame_cost(py::module_& module) {
  py::class_<PythonFrameCost>(
      module, "FrameCost",
      "The cost that a tracker minimises, of any states in one frame. Session.frame_cost() makes "
      "one. Batches are evaluated in parallel. States are arrays float64 (N, D), or (D,) for one.")
      .def(
          "look",
          [](PythonFrameCost& self, const py::object& frame, const Numbers& around) {
            Frame of;
            if (py::isinstance<Frame>(frame))
              of = *py::cast<std::shared_ptr<Frame>>(frame);
            else
              of.views = views_of(frame);
            of.index = std::max(of.index, 0);
            const Eigen::VectorXd state = finite_vector_of(around, self.dimension(), "around");
            self.call([&](FrameCost& cost) {
              cost.look(of, state);
              return 0;
            });
          },
          py::arg("frame"), py::arg("around"),
          "Prepares a Frame, or a list of pictures or Views: cuts tiles around the state `around` "
          "(D,) and prepares all terms. The pictures are kept, not copied.")
      .def("__call__", &costs_of, py::arg("states"),
           "Returns the costs (N,) of states (N, D), or a float of one; infinity is infeasible.")
      .def("terms", &terms_of, py::arg("states"),
           "Returns the costs (N,) of each term without its weight, by name.")
      .def("residuals", &residuals_of, py::arg("states"),
           "Returns the residuals float32 (N, M) of states (N, D), or (M,) of one, each times the "
           "root of its term's weight. Raises ConfigError if the objective has none.")
      .def("jacobian", &jacobian_of, py::arg("state"), py::arg("steps"),
           "Returns central differences of the residuals at a state (D,), float32 (M, D), over "
           "`steps` (D,) in metres and radians to each side; 0 leaves a column 0.")
      .def("normal_equations", &equations_of, py::arg("state"), py::arg("steps"),
           py::arg("blur") = 1.0,
           "Returns the analytic A = J^T J (D, D) and g = J^T r (D,) at a state (D,). Surfaces are "
           "posed `steps` (D,) beside it; silhouettes are blurred by `blur` pixels.")
      .def_property_readonly(
          "least_squares",
          [](PythonFrameCost& self) {
            return self.call([](FrameCost& cost) { return cost.least_squares(); });
          },
          "Whether the objective has residuals.")
      .def_property_readonly(
          "can_linearize",
          [](PythonFrameCost& self) {
            return self.call([](FrameCost& cost) { return cost.can_linearize(); });
          },
          "Whether normal_equations() works.")
      .def_property_readonly("term_names",
                             [](const PythonFrameCost& self) { return self.cost().term_names(); })
      .def_property_readonly(
          "weights", [](const PythonFrameCost& self) { return self.cost().weights(); },
          "Weights of the terms.")
      .def_property_readonly("scene", &PythonFrameCost::scene)
      .def_property_readonly("backend",
                             [](const PythonFrameCost& self) { return self.cost().backend(); });
}

}  // namespace hypotrack::python
