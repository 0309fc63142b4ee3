#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "hypotrack/plugin/judge.hpp"
#include "hypotrack/plugin/output.hpp"
#include "hypotrack/plugin/starter.hpp"
#include "plugins.hpp"
#include "search.hpp"
#include "tracker.hpp"

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

/// An optimizer in Python. Its answer is the best point that it evaluated.
class PythonOptimizer final : public Optimizer {
 public:
  explicit PythonOptimizer(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      if (!py::hasattr(o, "minimize"))
        throw PluginError("has no method minimize(self, cost, region, budget, seed)");
      evaluations_ = py::getattr(o, "default_evaluations", py::int_(1000)).cast<std::int64_t>();
      if (evaluations_ < 1) throw PluginError("its default_evaluations are less than 1");
      if (py::getattr(o, "needs_residuals", py::bool_(false)).cast<bool>())
        requirements_.least_squares = true;
      if (py::getattr(o, "needs_jacobian", py::bool_(false)).cast<bool>())
        requirements_ = {.least_squares = true, .jacobian = Linearization::needed};
    });
  }

  Requirements requirements() const override { return requirements_; }
  std::int64_t default_evaluations() const override { return evaluations_; }

  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override {
    check_search(cost, region, budget);
    const auto call = std::make_shared<BudgetedCost>(cost, region, budget);
    call->evaluate(region.start);
    const auto over = [&] {
      call->end();
      if (call->failure()) std::rethrow_exception(call->failure());
    };
    try {
      in_python([&] {
        try {
          object_->get().attr("minimize")(call, region, budget, seed);
        } catch (py::error_already_set& error) {
          if (!error.matches(budget_spent())) throw;
        }
      });
    } catch (...) {
      over();
      throw;
    }
    over();
    return call->best();
  }

 private:
  static py::object budget_spent() {
    return py::module_::import("hypotrack._core").attr("BudgetSpent");
  }

  std::shared_ptr<Held> object_;
  std::int64_t evaluations_ = 1000;
  Requirements requirements_ = {};
};

/// An output in Python.
class PythonOutput final : public Output {
 public:
  explicit PythonOutput(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      if (!py::hasattr(o, "frame")) throw PluginError("has no method frame(self, frame, solution)");
      names_ = py::getattr(o, "file_names", py::list()).cast<std::vector<std::string>>();
    });
  }

 private:
  std::vector<std::string> do_file_names() const override { return names_; }

  void do_begin(OutputContext& run) override {
    scene_ = std::make_shared<Scene>(run.scene());
    std::vector<std::pair<std::string, std::filesystem::path>> files;
    for (const std::string& name : names_)
      if (name.find('#') == std::string::npos) files.emplace_back(name, run.file(name));
    in_python([&] {
      if (!py::hasattr(object_->get(), "begin")) return;
      py::dict paths;
      for (const auto& [name, file] : files) paths[py::str(name)] = file;
      object_->get().attr("begin")(paths);
    });
  }

  void do_frame(const Frame& frame, const Solution& solution) override {
    in_python([&] {
      object_->get().attr("frame")(std::make_shared<Frame>(frame), NamedSolution{solution, scene_});
    });
  }

  void do_finish(bool complete) override {
    in_python([&] {
      if (py::hasattr(object_->get(), "finish")) object_->get().attr("finish")(complete);
    });
  }

  std::shared_ptr<Held> object_;
  std::shared_ptr<Scene> scene_;
  std::vector<std::string> names_;
};

/// A starter in Python: it looks for models if it has a method find().
class PythonStarter final : public Starter {
 public:
  explicit PythonStarter(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      looks_ = py::hasattr(o, "find");
      if (!looks_ && !py::hasattr(o, "state"))
        throw PluginError(
            "has no method find(self, frame, cameras, model) or state(self, frame, cameras)");
      detects_ = py::getattr(o, "detects", py::bool_(false)).cast<bool>();
    });
  }

 private:
  bool do_looks() const override { return looks_; }
  bool do_detects(std::size_t /*model*/) const override { return detects_; }

  std::optional<Eigen::VectorXd> do_state(const StarterContext& context) override {
    return in_python([&]() -> std::optional<Eigen::VectorXd> {
      const py::object answer = object_->get().attr("state")(frame_of(context), context.cameras);
      if (!answer.is_none()) return vector_of(numbers_of(answer), "its state");
      if (context.frame) throw PluginError("its state() returned None although there is a frame");
      return std::nullopt;
    });
  }

  void do_find(const StarterContext& context, std::size_t model, const TakePose& take) override {
    in_python([&] {
      const py::object poses = object_->get().attr("find")(frame_of(context), context.cameras,
                                                           context.scene.items()[model].name);
      if (poses.is_none()) return;
      for (const py::handle pose : poses) {
        const Eigen::VectorXd parameters = vector_of(numbers_of(pose), "a pose of find()");
        if (!without_gil([&] { return take(parameters); })) return;  // it may search
      }
    });
  }

  static py::object frame_of(const StarterContext& context) {
    if (!context.frame) return py::none();
    return py::cast(std::make_shared<Frame>(*context.frame));
  }

  std::shared_ptr<Held> object_;
  bool looks_ = false, detects_ = false;
};

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

std::unique_ptr<Optimizer> python_optimizer(std::shared_ptr<Held> object) {
  return std::make_unique<PythonOptimizer>(std::move(object));
}

std::unique_ptr<Output> python_output(std::shared_ptr<Held> object) {
  return std::make_unique<PythonOutput>(std::move(object));
}

std::unique_ptr<Starter> python_starter(std::shared_ptr<Held> object) {
  return std::make_unique<PythonStarter>(std::move(object));
}

}  // namespace hypotrack::python
