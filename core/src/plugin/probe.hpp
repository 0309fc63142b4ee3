#pragma once

#include <filesystem>

#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// The descriptor that the probe program writes to, so that nothing a plugin prints gets in
/// between.
inline constexpr int kProbeDescriptor = 3;

// What it writes there: a line when each step begins, and the result as one line of JSON.
inline constexpr const char* kProbeLoading = "while loading";
inline constexpr const char* kProbeEntry = "while returning its descriptor";
inline constexpr const char* kProbeDescribing = "while describing its parameters";

/// The whole of the probe program: opens a library and reports. Does not return.
[[noreturn]] HYPOTRACK_API void run_probe(const std::filesystem::path& file);

}  // namespace hypotrack::detail
