#include <pybind11/stl.h>

#include "hypotrack/plugin/judge.hpp"
#include "plugins.hpp"

namespace hypotrack::python {
namespace {

/// A judge in Python. It may be asked by any thread.
class PythonJudge final : public Judge {
 public:
  PythonJudge(std::shared_ptr<Held> object, const JudgeThresholds& thresholds)
      : Judge(thresholds), object_(std::move(object)) {
    in_python([&] {
      if (!py::hasattr(object_->get(), "log_odds"))
        throw PluginError("has no method log_odds(self, measures)");
    });
  }

 protected:
  double do_log_odds(const Measures& measures) const override {
    return in_python([&] { return object_->get().attr("log_odds")(measures).cast<double>(); });
  }

 private:
  std::shared_ptr<Held> object_;
};

py::dict by_name(const std::array<double, Measures::kCount>& values) {
  py::dict all;
  const auto infos = measure_infos();
  for (std::size_t i = 0; i < values.size(); ++i) all[py::str(infos[i].name)] = values[i];
  return all;
}

}  // namespace

std::unique_ptr<Judge> python_judge(std::shared_ptr<Held> object,
                                    const JudgeThresholds& thresholds) {
  return std::make_unique<PythonJudge>(std::move(object), thresholds);
}

void add_judge(py::module_& module) {
  py::class_<Measures>(module, "Measures",
                       "How well the pictures support the pose of a model; `hypotrack plugins "
                       "measures` lists the names.")
      .def_property_readonly(
          "values", [](const Measures& m) { return by_name(m.values); }, "In this frame, by name.")
      .def_property_readonly(
          "usual", [](const Measures& m) { return by_name(m.usual); },
          "Mean of frames in which the pose was surely right, by name.")
      .def_readonly("experienced", &Measures::experienced, "Whether there were such frames.")
      .def_readonly("likeness", &Measures::likeness,
                    "Correlation of the surface's colours with its earlier ones; NaN: unknown.")
      .def_readonly("usual_likeness", &Measures::usual_likeness)
      .def_readonly("covered", &Measures::covered,
                    "Share of the model's drawn points that others hide.")
      .def_readonly("points", &Measures::points, "Grid points that show it in the first view.")
      .def_readonly("tracked", &Measures::tracked, "Whether the model was tracked before.")
      .def_readonly("model", &Measures::model, "Number of the model in the scene.");
}

}  // namespace hypotrack::python
