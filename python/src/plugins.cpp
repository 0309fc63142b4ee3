#include "plugins.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "hypotrack/plugin/plugin_object.hpp"

namespace hypotrack::python {
namespace {

std::vector<ProgramPlugin>& registry() {
  static auto* const kPlugins = new std::vector<ProgramPlugin>;  // outlives Python
  return *kPlugins;
}

[[noreturn]] void fail(const py::object& type, const std::string& problem) {
  throw PluginError(fmt::format(
      "{}: {}", py::cast<std::string>(py::getattr(type, "__name__", py::repr(type))), problem));
}

/// Returns the value of a default, or one of the annotated type.
PythonParams::Value value_of_default(const py::object& type, const std::string& name,
                                     const py::object& value, const py::object& annotation) {
  const auto is = [&](const char* text) {
    return annotation.is(py::module_::import("builtins").attr(text)) ||
           (py::isinstance<py::str>(annotation) && py::cast<std::string>(annotation) == text);
  };
  const py::object path = py::module_::import("pathlib").attr("PurePath");
  const bool given = static_cast<bool>(value);
  if (given ? py::isinstance<py::bool_>(value) : is("bool")) return given && py::cast<bool>(value);
  if (given && py::isinstance<py::int_>(value) && is("float")) return py::cast<double>(value);
  if (given ? py::isinstance<py::int_>(value) : is("int"))
    return given ? py::cast<std::int64_t>(value) : 0;
  if (given ? py::isinstance<py::float_>(value) : is("float"))
    return given ? py::cast<double>(value) : 0.0;
  if (given ? py::isinstance<py::str>(value) : is("str"))
    return given ? py::cast<std::string>(value) : std::string();
  if (given && py::isinstance(value, path)) return py::cast<std::filesystem::path>(value);
  if (!given && py::isinstance(annotation, py::module_::import("builtins").attr("type")) &&
      PyObject_IsSubclass(annotation.ptr(), path.ptr()) == 1)
    return std::filesystem::path();
  if (given && (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))) {
    const auto items = py::cast<py::sequence>(value);
    if (items.size() > 0 && py::isinstance<py::str>(items[0]))
      return py::cast<std::vector<std::string>>(value);
    return py::cast<std::vector<double>>(value);
  }
  fail(type, fmt::format("the parameter '{}' of its constructor has no type that scenes can give; "
                         "write a default, or an annotation: bool, int, float, str or Path",
                         name));
}

py::object to_python(const PythonParams::Value& value) {
  return std::visit([](const auto& v) -> py::object { return py::cast(v); }, value);
}

/// Makes a plugin; says which it is in what Python raises.
template <class T, class Make>
std::unique_ptr<T> named(const PluginContext& context, const std::string& name, const Make& make) {
  try {
    return make();
  } catch (const PluginError& error) {
    throw PluginError(fmt::format("{}: {} '{}': {}", context.config().where(), kPluginKind<T>, name,
                                  error.what()));
  }
}

template <class T>
ProgramPlugin plugin_of(const std::string& name, const py::object& type,
                        std::unique_ptr<T> (*wrap)(std::shared_ptr<Held>)) {
  const auto held = std::make_shared<Held>(type);
  return program_plugin<T>(name, [held, wrap, name](PluginContext& context) {
    return named<T>(context, name, [&] { return wrap(make_object(held->get(), context)); });
  });
}

/// Refuses parameters with the name of a threshold, which scenes give to every judge.
void check_names_of_judge(const py::object& type) {
  const std::string thresholds = "\n" + dump_params(JudgeThresholds());
  for (const auto& parameter : params_of(type).all)
    if (thresholds.find("\n" + parameter.name + ":") != thresholds.npos)
      fail(type, fmt::format("the parameter '{}' of its constructor has the name of a threshold "
                             "that every judge has; name it otherwise",
                             parameter.name));
}

ProgramPlugin judge_plugin(const std::string& name, const py::object& type) {
  check_names_of_judge(type);
  const auto held = std::make_shared<Held>(type);
  return program_plugin<Judge>(name, [held, name](PluginContext& context) {
    return named<Judge>(context, name, [&] {
      JudgeThresholds thresholds;
      auto object = make_object(held->get(), context, &thresholds);
      return python_judge(std::move(object), thresholds);
    });
  });
}

/// The parameters of a class and, for a judge, its thresholds.
struct AllParams {
  PythonParams own = {};
  JudgeThresholds* thresholds = nullptr;
  void visit(ParamVisitor& v) {
    if (thresholds) thresholds->visit(v);
    own.visit(v);
  }
};

ProgramPlugin make_plugin(const std::string& kind, const std::string& name,
                          const py::object& type) {
  if (kind == kPluginKind<Optimizer>) return plugin_of(name, type, &python_optimizer);
  if (kind == kPluginKind<Objective>) return plugin_of(name, type, &python_objective);
  if (kind == kPluginKind<Judge>) return judge_plugin(name, type);
  if (kind == kPluginKind<Source>) return plugin_of(name, type, &python_source);
  if (kind == kPluginKind<Starter>) return plugin_of(name, type, &python_starter);
  if (kind == kPluginKind<Output>) return plugin_of(name, type, &python_output);
  throw PluginError(
      fmt::format("there are no plugins of the kind '{}' in Python; expected optimizer, objective, "
                  "starter, judge, "
                  "source or output",
                  kind));
}

void register_plugin(std::string kind, const std::string& name, const py::object& type) {
  if (kind.ends_with('s')) kind.pop_back();
  (void)params_of(type);  // finds mistakes now
  ProgramPlugin plugin = make_plugin(kind, name, type);
  PluginLoader().add(plugin);  // the same
  auto& all = registry();
  std::erase_if(all, [&](const ProgramPlugin& p) { return p.kind == kind && p.name == name; });
  all.push_back(std::move(plugin));
}

}  // namespace

void PythonParams::visit(ParamVisitor& v) {
  for (Parameter& p : all)
    std::visit([&](auto& value) { v(p.name, value, {.help = "", .required = p.required}); },
               p.value);
}

namespace {

/// Returns a signature, with annotations that are texts evaluated where that works.
py::object signature_of(const py::object& function) {
  const py::object signature = py::module_::import("inspect").attr("signature");
  try {
    return signature(function, py::arg("eval_str") = true);
  } catch (const py::error_already_set&) {
    return signature(function);
  }
}

}  // namespace

PythonParams params_of(const py::object& type) {
  PythonParams params;
  if (!PyType_Check(type.ptr())) fail(type, "expected a class");
  const py::object init = type.attr("__init__");
  if (init.is(py::module_::import("builtins").attr("object").attr("__init__"))) return params;
  const py::module_ inspect = py::module_::import("inspect");
  const py::object kinds = inspect.attr("Parameter");
  bool is_self = true;
  for (const py::handle item : signature_of(init).attr("parameters").attr("values")()) {
    if (std::exchange(is_self, false)) continue;
    const py::object kind = item.attr("kind");
    if (kind.equal(kinds.attr("VAR_POSITIONAL")) || kind.equal(kinds.attr("VAR_KEYWORD"))) continue;
    const auto name = py::cast<std::string>(item.attr("name"));
    const py::object given = item.attr("default");
    const bool required = given.is(kinds.attr("empty"));
    if (name == "type" || kind.equal(kinds.attr("POSITIONAL_ONLY")))
      fail(type,
           fmt::format("the parameter '{}' of its constructor has the name of the plugin's own "
                       "key, or is positional only; name it otherwise",
                       name));
    try {
      params.all.push_back(
          {name,
           value_of_default(type, name, required ? py::object() : given, item.attr("annotation")),
           required});
    } catch (const py::cast_error&) {
      fail(type,
           fmt::format("the default of the parameter '{}' of its constructor is no value that "
                       "scenes can give: {}",
                       name, py::cast<std::string>(py::repr(given))));
    }
  }
  return params;
}

std::shared_ptr<Held> make_object(const py::object& type, PluginContext& context,
                                  JudgeThresholds* thresholds) {
  AllParams all{in_python([&] { return params_of(type); }), thresholds};
  const PythonParams params = context.read(std::move(all)).own;
  return in_python([&] {
    py::dict arguments;
    for (const PythonParams::Parameter& p : params.all)
      arguments[py::str(p.name)] = to_python(p.value);
    const py::object object = type.attr("__new__")(type);
    object.attr("log") = context.log();
    object.attr("scene") = std::make_shared<Scene>(context.scene());
    object.attr("__init__")(**arguments);
    return std::make_shared<Held>(object);
  });
}

std::vector<ProgramPlugin> registered_plugins() { return registry(); }

void add_plugins(py::module_& module) {
  py::class_<PluginLog>(module, "PluginLog", "Tells the user something under a plugin's name.")
      .def("note", &PluginLog::note, py::arg("text"), py::call_guard<WithoutGil>(),
           "Tells what is good to know, once per text.")
      .def("warning", &PluginLog::warning, py::arg("text"), py::call_guard<WithoutGil>(),
           "Tells what probably makes results worse.");
  module.def(
      "register", &register_plugin, py::arg("kind"), py::arg("name"), py::arg("cls"),
      "Makes a class the plugin `type: name` of scenes that are opened afterwards in this "
      "process. `kind` is optimizer, objective, starter, judge, source or output. The parameters "
      "of "
      "its "
      "constructor are those of the plugin. Objects get `log` and `scene` before it runs. A source "
      "gives new arrays with every frame, since frames are read ahead.");
}

}  // namespace hypotrack::python
