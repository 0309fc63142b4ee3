#pragma once

#include <filesystem>

namespace hypotrack {

/// Makes a folder for results, with those above it, unless it is there. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace hypotrack
