#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "doctor/check.hpp"

namespace hypotrack::doctor {

/// Checks the plugin folders and opens every plugin in a child process.
std::vector<Check> check_plugins(std::span<const std::filesystem::path> extra_folders);

}  // namespace hypotrack::doctor
