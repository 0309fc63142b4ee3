#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "common.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::python {

/// The parameters of a Python class: those of its constructor.
struct PythonParams {
  using Value = std::variant<bool, std::int64_t, double, std::string, std::filesystem::path,
                             std::vector<double>, std::vector<std::string>>;
  struct Parameter {
    std::string name;
    Value value;
    bool required = false;
  };
  std::vector<Parameter> all = {};

  void visit(ParamVisitor& v);
};

/// Reads the parameters of a class from its signature. Throws PluginError on a parameter without a
/// type that scenes can give. The caller has the GIL.
PythonParams params_of(const py::object& type);

/// Makes an object of a class for a plugin: reads its parameters from the context, and gives it
/// `log` and `scene`. The caller has no GIL.
/// `thresholds`, if given, are parameters, too.
std::shared_ptr<Held> make_object(const py::object& type, PluginContext& context,
                                  JudgeThresholds* thresholds = nullptr);

/// Returns the plugins that were registered in this process.
std::vector<ProgramPlugin> registered_plugins();

// Each makes a plugin of an object in Python.
std::unique_ptr<Optimizer> python_optimizer(std::shared_ptr<Held> object);
std::unique_ptr<Objective> python_objective(std::shared_ptr<Held> object);
std::unique_ptr<Judge> python_judge(std::shared_ptr<Held> object,
                                    const JudgeThresholds& thresholds);
std::unique_ptr<Source> python_source(std::shared_ptr<Held> object);
std::unique_ptr<Starter> python_starter(std::shared_ptr<Held> object);
std::unique_ptr<Output> python_output(std::shared_ptr<Held> object);

}  // namespace hypotrack::python
