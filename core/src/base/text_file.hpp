#pragma once

#include <filesystem>
#include <string_view>

#include "base/exported.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Checks early that write_whole() can work for a file, for results of long work. Throws
/// OutputError if it cannot, which says that `option` names another file.
void expect_writable(const std::filesystem::path& file, std::string_view option = "--out");

/// Writes a file beside its place and moves it there, so that it is never seen incomplete. Writes
/// into a device or pipe directly, and into the file that a link names. Throws OutputError.
void write_whole(const std::filesystem::path& file, std::string_view text);

/// Makes a folder for results, with those above it, unless it is there. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace internal
}  // namespace hypotrack
