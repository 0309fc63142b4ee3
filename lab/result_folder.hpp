#pragma once

#include <filesystem>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Makes a folder for results, with those above it, unless it is there. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace internal
}  // namespace hypotrack
