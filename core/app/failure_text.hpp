#pragma once

#include <string>

namespace hypotrack::app {

/// Returns what the program says of the exception that is being handled, without `hypotrack: `.
std::string failure_text();

}  // namespace hypotrack::app
