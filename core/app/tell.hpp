#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace hypotrack::app {

/// Prints to the standard error. Where that cannot be, as when the terminal is closed, the words
/// are lost and the work goes on.
template <class... T>
void tell(fmt::format_string<T...> format, T&&... values) {
  std::fputs(fmt::format(format, std::forward<T>(values)...).c_str(), stderr);
}

}  // namespace hypotrack::app
