#pragma once

#include <filesystem>
#include <string>

#include "base/exported.hpp"
#include "run/crew/process_pool.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns why a program failed: hypotrack's own message in its log, or else how it ended and the
/// log's last line.
std::string failure_message(const std::filesystem::path& log, const Ended& ended);

}  // namespace internal
}  // namespace hypotrack
