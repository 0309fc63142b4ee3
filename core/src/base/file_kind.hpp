#pragma once

#include <filesystem>
#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Says why a path is no regular file: `no such file`, `is a folder`, `is a device`. Empty if it is
/// one.
std::string why_no_file(const std::filesystem::path& path);

}  // namespace internal
}  // namespace hypotrack
