#pragma once

#include <filesystem>
#include <string>

#include "lab/study/process_pool.hpp"

namespace hypotrack::study {

/// Returns why a program failed: hypotrack's own message in its log, or else how it ended and the
/// log's last line.
std::string failure_message(const std::filesystem::path& log, const Ended& ended);

}  // namespace hypotrack::study
