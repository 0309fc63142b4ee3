#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "output/run/summary.hpp"

namespace hypotrack::app {

/// Returns what the program says of the exception that is being handled, without `hypotrack: `.
std::string failure_text();

/// Returns the lines that a run ends with: speed, errors, where the results are.
std::string summary_text(const Summary& summary, const std::filesystem::path& out);

/// Returns the lines of summary_text() in what a run said; empty if there are none.
std::string summary_in(const std::string& log);

/// What a run says that was interrupted before it wrote anything, and what after, without
/// `hypotrack: `.
inline constexpr const char* kInterruptedEarly =
    "interrupted before the first frame; nothing was written";
inline constexpr const char* kInterruptedLate = "interrupted; the files hold the frames so far";

/// Prints to stderr. If that fails, as on a closed terminal, the text is lost and the program goes
/// on.
template <class... T>
void tell(fmt::format_string<T...> format, T&&... values) {
  std::fputs(fmt::format(format, std::forward<T>(values)...).c_str(), stderr);
}

}  // namespace hypotrack::app
