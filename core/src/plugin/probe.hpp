#pragma once

#include <filesystem>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// File descriptor of the probe program's report, separate from anything that a plugin prints.
inline constexpr int kProbeDescriptor = 3;

// Lines of the report: one as each step begins, then the result as one line of JSON.
inline constexpr const char* kProbeLoading = "while loading";
inline constexpr const char* kProbeEntry = "while returning its descriptor";
inline constexpr const char* kProbeDescribing = "while describing its parameters";

/// Opens a library, writes the report and exits: the probe program's main function.
[[noreturn]] void run_probe(const std::filesystem::path& file);

}  // namespace internal
}  // namespace hypotrack::detail
