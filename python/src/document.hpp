#pragma once

#include "common.hpp"
#include "hypotrack/config_value.hpp"

namespace hypotrack::python {

/// Returns the value of nested dicts, lists, tuples, texts, numbers, bools, paths, numpy arrays and
/// None. Throws ConfigError, naming the key path, on anything else.
ConfigValue value_of(const py::handle& object, const std::string& path = {});

/// Returns nested dicts, lists, texts, numbers, bools and None of a node.
py::object object_of(const ConfigNode& node);

}  // namespace hypotrack::python
