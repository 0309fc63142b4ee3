#pragma once

#include <filesystem>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the folder that contains lib/ and share/: the installation or build tree of this
/// libhypotrack.so. Throws PluginError if it cannot be found.
std::filesystem::path prefix_folder();

}  // namespace internal
}  // namespace hypotrack::detail
