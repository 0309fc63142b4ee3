#pragma once

#include <filesystem>
#include <string>

namespace hypotrack {

/// Says why a path is no regular file: `no such file`, `is a folder`, `is a device`. Empty if it is
/// one.
std::string why_no_file(const std::filesystem::path& path);

}  // namespace hypotrack
