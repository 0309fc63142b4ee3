#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace hypotrack::app {

/// Prints to stderr. If that fails, as on a closed terminal, the text is lost and the program goes
/// on.
template <class... T>
void tell(fmt::format_string<T...> format, T&&... values) {
  std::fputs(fmt::format(format, std::forward<T>(values)...).c_str(), stderr);
}

}  // namespace hypotrack::app
