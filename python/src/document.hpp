#pragma once

#include "common.hpp"
#include "hypotrack/api/config_value.hpp"

namespace hypotrack::python {

/// Returns the value of nested dicts, lists, tuples, texts, numbers, bools, paths, numpy arrays and
/// None. Throws ConfigError, naming the document and the key path, on anything else.
ConfigValue value_of(const py::handle& object, const std::string& document);

/// Returns a value as YAML in one line, for overrides.
std::string line_of(const ConfigNode& node);

}  // namespace hypotrack::python
