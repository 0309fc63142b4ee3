#include "output/metrics/metrics.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <limits>

#include "arrays.hpp"
#include "output/evaluate/evaluation.hpp"

namespace hypotrack::python {
namespace {

py::object parsed(const Metrics& metrics) {
  return py::module_::import("json").attr("loads")(to_json(metrics));
}

py::object evaluate_run(const std::filesystem::path& run,
                        const std::optional<std::filesystem::path>& truth, double run_unit,
                        double truth_unit) {
  const Metrics metrics = without_gil([&] {
    return evaluate({.run = run,
                     .truth = truth,
                     .run_metres_per_unit = run_unit,
                     .truth_metres_per_unit = truth_unit,
                     .rename = {}})
        .metrics;
  });
  return parsed(metrics);
}

/// Returns the frames (3xL each) of an array (N, L, 3).
std::vector<Eigen::Matrix3Xd> frames_of(const Numbers& array, std::size_t landmarks,
                                        const char* what) {
  if (array.ndim() != 3 || array.shape(1) != static_cast<py::ssize_t>(landmarks) ||
      array.shape(2) != 3)
    array.refuse(what, fmt::format("(N, {}, 3)", landmarks));
  std::vector<Eigen::Matrix3Xd> frames;
  const auto size = static_cast<Eigen::Index>(landmarks);
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    frames.emplace_back(Eigen::Map<const Eigen::Matrix3Xd>(array.array.data(i), 3, size));
  return frames;
}

py::object metrics_of(const std::vector<std::string>& names, const Numbers& estimate,
                      const Numbers& truth, const py::object& times) {
  const auto estimates = frames_of(estimate, names.size(), "estimate");
  const auto truths = frames_of(truth, names.size(), "truth");
  if (estimates.size() != truths.size())
    throw Error(fmt::format("estimate has {} frames, truth has {}; expected as many",
                            estimates.size(), truths.size()));
  Eigen::VectorXd seconds;
  if (!times.is_none()) seconds = vector_of(numbers_of(times), std::ssize(estimates), "times");
  MetricsCollector collector(landmark_layout(names));
  Eigen::VectorXd errors(std::ssize(estimates));
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double time = times.is_none() ? std::numeric_limits<double>::quiet_NaN() : seconds[k];
    errors[k] = collector.add(static_cast<int>(i), time, {}, estimates[i], truths[i]).mean;
  }
  py::object all = parsed(collector.metrics());
  all["errors"] = array_of(errors);
  return all;
}

}  // namespace

void add_metrics(py::module_& module) {
  module.def("evaluate", &evaluate_run, py::arg("run"), py::arg("truth") = py::none(),
             py::kw_only(), py::arg("metres_per_unit") = 1.0,
             py::arg("truth_metres_per_unit") = 1.0,
             "Compares a run's folder, or a table of landmarks, with the truth in that folder, in "
             "another one or in a table. Returns a dict: docs/reference/metrics.md defines the "
             "numbers, which are millimetres.");
  module.def("metrics", &metrics_of, py::arg("landmark_names"), py::arg("estimate"),
             py::arg("truth"), py::arg("times") = py::none(),
             "Compares landmarks (N, L, 3) of N frames with their truth, both in metres, NaN where "
             "unknown. Returns the dict of evaluate(), and `errors` (N,): the error of each frame "
             "in metres. `times` (N,) is in seconds.");
}

}  // namespace hypotrack::python
