#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>

#include "common.hpp"

namespace hypotrack::python {
namespace {

constexpr int kMostLevels = 64;

std::string below(const std::string& path, const std::string& step) {
  return path.empty() ? step : path + "." + step;
}

[[noreturn]] void fail(const std::string& path, const std::string& problem) {
  throw ConfigError(fmt::format("{}{}", path.empty() ? "" : path + ": ", problem));
}

/// Returns a text as UTF-8. Throws ConfigError, naming `path`, on lone surrogates.
std::string utf8_of(const py::handle& text, const std::string& path) {
  py::ssize_t size = 0;
  const char* bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
  if (bytes) return {bytes, static_cast<std::size_t>(size)};
  PyErr_Clear();
  fail(path,
       fmt::format("the text {} has no UTF-8",
                   py::cast<std::string>(py::module_::import("builtins").attr("ascii")(text))));
}

/// Returns a text as YAML and JSON quote it.
std::string quoted(const std::string& text) {
  return py::cast<std::string>(
      py::module_::import("json").attr("dumps")(text, py::arg("ensure_ascii") = false));
}

ConfigValue convert(const py::handle& object, const std::string& path, int level);

ConfigValue convert_dict(const py::dict& dict, const std::string& path, int level) {
  ConfigValue::Map entries;
  for (const auto& [key, value] : dict) {
    if (!py::isinstance<py::str>(key))
      fail(path, fmt::format("the key {} is no text", py::cast<std::string>(py::repr(key))));
    const std::string name = utf8_of(key, path);
    entries.emplace_back(name, convert(value, below(path, name), level + 1));
  }
  return ConfigValue::map(entries);
}

ConfigValue convert_items(const py::handle& items, const std::string& path, int level) {
  ConfigValue::List list;
  std::size_t i = 0;
  for (const py::handle item : items)
    list.push_back(convert(item, below(path, std::to_string(i++)), level + 1));
  return ConfigValue::list(list);
}

ConfigValue convert_integer(const py::handle& object, const std::string& path) {
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
  if (!number) throw py::error_already_set();
  int overflow = 0;
  const long long value = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
  if (overflow != 0) fail(path, "the integer has more than 64 bits");
  return ConfigValue(value);
}

ConfigValue convert(const py::handle& object, const std::string& path, int level) {
  if (level > kMostLevels) fail(path, fmt::format("nested deeper than {} levels", kMostLevels));
  if (object.is_none()) return {};
  if (py::isinstance<py::bool_>(object)) return ConfigValue(object.cast<bool>());
  if (py::isinstance<py::str>(object)) return ConfigValue(utf8_of(object, path));
  if (py::isinstance<py::dict>(object))
    return convert_dict(py::reinterpret_borrow<py::dict>(object), path, level);
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object))
    return convert_items(object, path, level);
  if (py::isinstance<py::array>(object) || py::hasattr(object, "tolist"))  // and numpy's scalars
    return convert(object.attr("tolist")(), path, level + 1);
  if (PyIndex_Check(object.ptr())) return convert_integer(object, path);
  if (py::isinstance<py::float_>(object)) return ConfigValue(object.cast<double>());
  if (py::hasattr(object, "__fspath__"))
    return convert(object.attr("__fspath__")(), path, level + 1);
  fail(path, fmt::format("expected a dict, list, text, number, bool, path or None; found {}",
                         py::cast<std::string>(py::type::of(object).attr("__name__"))));
}

}  // namespace

ConfigValue value_of(const py::handle& object, const std::string& document) {
  try {
    return convert(object, {}, 0);
  } catch (const ConfigError& error) {
    throw ConfigError(fmt::format("{}: {}", document, error.what()));
  }
}

std::string line_of(const ConfigNode& node) {
  std::vector<std::string> parts;
  if (node.is_map()) {
    for (const std::string& key : node.keys())
      parts.push_back(fmt::format("{}: {}", quoted(key), line_of(node.get(key))));
    return fmt::format("{{{}}}", fmt::join(parts, ", "));
  }
  if (node.is_list()) {
    for (std::size_t i = 0; i < node.size(); ++i) parts.push_back(line_of(node.at(i)));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  if (node.is_null() || !node.defined()) return "null";
  return node.is_plain() ? node.scalar() : quoted(node.scalar());
}

}  // namespace hypotrack::python
