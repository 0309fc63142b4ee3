#include "search.hpp"

#include <pybind11/stl.h>

#include "hypotrack/plugin/linearization.hpp"

namespace hypotrack::python {

BudgetedCost::BudgetedCost(CostFunction& cost, const SearchRegion& region, const Budget& budget)
    : cost_(&cost), region_(region), budget_(budget), deadline_(budget.seconds) {}

CostFunction& BudgetedCost::cost() const {
  if (!cost_) throw Error("this search is over: its cost cannot be evaluated any more");
  return *cost_;
}

void BudgetedCost::end() {
  while (busy_.exchange(true)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  cost_ = nullptr;
  busy_ = false;
}

void BudgetedCost::spend(std::int64_t evaluations) const {
  // The first evaluation, of the start, always takes place.
  if (evaluations > left() || (best_.result().evaluations > 0 && deadline_.passed()))
    throw BudgetSpent();
}

template <class Function>
auto BudgetedCost::keeping_failure(const Function& function) {
  try {
    return function();
  } catch (...) {
    failure_ = std::current_exception();
    throw;
  }
}

Eigen::VectorXd BudgetedCost::evaluate(Eigen::MatrixXd points) {
  const Busy busy(busy_, "search");
  CostFunction& from = cost();
  spend(points.cols());
  for (auto point : points.colwise()) point = within_bounds(point, region_);
  Eigen::VectorXd costs(points.cols());
  if (points.cols() == 0) return costs;
  return keeping_failure([&] {
    from.evaluate(points, costs);
    best_.update(points, costs);
    return costs;
  });
}

Eigen::MatrixXf BudgetedCost::residuals(Eigen::MatrixXd points) {
  if (!has_residuals()) throw ConfigError("the scene's objective has no residuals");
  const Busy busy(busy_, "search");
  ResidualCost& from = *cost().residuals();
  spend(points.cols());
  for (auto point : points.colwise()) point = within_bounds(point, region_);
  return keeping_failure([&] {
    Eigen::MatrixXf out(from.count(), points.cols());
    Eigen::VectorXd costs(points.cols());
    if (points.cols() == 0) return out;
    from.evaluate(points, out, costs);
    best_.update(points, costs);
    return out;
  });
}

NormalEquations BudgetedCost::linearize(const Eigen::VectorXd& point, double blur) {
  if (!can_linearize()) throw ConfigError("the scene's objective has no analytic derivatives");
  const Busy busy(busy_, "search");
  ResidualCost& from = *cost().residuals();
  spend(from.linearize_price(dimension()));
  const Neighbourhood at =
      neighbourhood(point, difference_steps(region_, point, linearize_share(from, 0.02)), blur);
  return keeping_failure([&] {
    NormalEquations found = from.linearize(at.points, at.steps, at.blur);
    best_.count(from.linearize_price(dimension()));
    return found;
  });
}

namespace {

py::object costs_of(BudgetedCost& call, const Numbers& points) {
  const Eigen::MatrixXd columns = columns_of(points, call.dimension(), "points");
  if (!columns.allFinite()) throw Error("points: a number is not finite");
  const Eigen::VectorXd costs = without_gil([&] { return call.evaluate(columns); });
  if (points.ndim() == 1) return py::float_(costs[0]);
  return array_of(costs);
}

py::array residuals_of(BudgetedCost& call, const Numbers& points) {
  const Eigen::MatrixXd columns = columns_of(points, call.dimension(), "points");
  if (!columns.allFinite()) throw Error("points: a number is not finite");
  return rows_of<float>(without_gil([&] { return call.residuals(columns); }), points.ndim() == 1);
}

py::tuple equations_of(BudgetedCost& call, const Numbers& point, double blur) {
  const Eigen::VectorXd at = finite_vector_of(point, call.dimension(), "point");
  check_blur(blur);
  const NormalEquations found = without_gil([&] { return call.linearize(at, blur); });
  return py::make_tuple(rows_of<double>(found.a), array_of(found.g));
}

py::list groups_of(const SearchRegion& region) {
  py::list groups;
  for (const SearchGroup& group : region.groups)
    groups.append(
        py::make_tuple(group.kind == SearchGroup::Kind::pose ? "pose" : "limb", group.dimensions));
  return groups;
}

void add_region(py::module_& module) {
  py::class_<SearchRegion>(module, "SearchRegion",
                           "Start, bounds and spread of a search; arrays (D,).")
      .def_property_readonly("start", [](const SearchRegion& r) { return array_of(r.start); })
      .def_property_readonly(
          "lower", [](const SearchRegion& r) { return array_of(r.lower); },
          "Hard bounds; may be infinite.")
      .def_property_readonly("upper", [](const SearchRegion& r) { return array_of(r.upper); })
      .def_property_readonly(
          "spread", [](const SearchRegion& r) { return array_of(r.spread); },
          "Plausible distance of the answer from the start, to each side; above 0.")
      .def_property_readonly(
          "previous",
          [](const SearchRegion& r) {
            return r.previous.size() == 0 ? py::object(py::none()) : array_of(r.previous);
          },
          "Point of the previous frame's answer, perhaps outside the bounds, or None.")
      .def_readonly("seconds_since_previous", &SearchRegion::seconds_since_previous)
      .def_property_readonly("groups", &groups_of,
                             "(kind, dimensions) of each model's pose and each limb.");
  py::class_<Budget>(module, "Budget", "Limits of a search.")
      .def_readonly("evaluations", &Budget::evaluations)
      .def_readonly("seconds", &Budget::seconds)
      .def_readonly("usual_cost", &Budget::usual_cost,
                    "Cost of a good answer in recent searches; -infinity: unknown.");
}

}  // namespace

void add_search(py::module_& module) {
  py::register_exception<BudgetSpent>(module, "BudgetSpent").attr("__doc__") =
      "Ends a search whose budget is spent. Optimizers let it pass.";
  add_region(module);
  py::class_<BudgetedCost, std::shared_ptr<BudgetedCost>>(
      module, "SearchCost",
      "The cost of search points, for optimizers. The start has been evaluated, and the best point "
      "evaluated is the answer of the search.")
      .def("__call__", &costs_of, py::arg("points"),
           "Returns the costs (N,) of points (N, D), or a float of one point (D,). Points outside "
           "the bounds are moved onto them. Pass many points at once: they are evaluated in "
           "parallel. Raises BudgetSpent if there are more than evaluations_left.")
      .def("residuals", &residuals_of, py::arg("points"),
           "Returns the residuals float32 (N, M) of points (N, D), or (M,) of one. Counts as they "
           "do. Raises ConfigError if the objective has none.")
      .def("normal_equations", &equations_of, py::arg("point"), py::arg("blur") = 1.0,
           "Returns the analytic A = J^T J (D, D) and g = J^T r (D,) at a point (D,).")
      .def_property_readonly("has_residuals", &BudgetedCost::has_residuals)
      .def_property_readonly("can_linearize", &BudgetedCost::can_linearize)
      .def_property_readonly("dimension", &BudgetedCost::dimension)
      .def_property_readonly("evaluations_left", &BudgetedCost::left)
      .def_property_readonly(
          "best_point", [](const BudgetedCost& c) { return array_of(c.best().point); },
          "The best point so far (D,).")
      .def_property_readonly("best_cost", [](const BudgetedCost& c) { return c.best().cost; });
}

}  // namespace hypotrack::python
