#pragma once

#include <filesystem>

namespace hypotrack::detail {

/// Returns the folder that contains lib/ and share/: the installation or build tree of this
/// libhypotrack.so. Throws PluginError if it cannot be found.
std::filesystem::path prefix_folder();

}  // namespace hypotrack::detail
