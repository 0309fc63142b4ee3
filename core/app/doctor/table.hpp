#pragma once

#include <span>
#include <string>

#include "doctor/check.hpp"

namespace hypotrack::doctor {

/// Returns true if nothing is wrong with what every run needs.
bool is_ready(std::span<const Check> checks);

/// Formats a line per check, with a remedy below each problem, and a conclusion.
std::string text_of(std::span<const Check> checks);

/// Formats the checks as JSON: `ready`, and per check its name, state, needed, found and fix.
std::string json_of(std::span<const Check> checks);

}  // namespace hypotrack::doctor
