#pragma once

#include <filesystem>
#include <memory>

#include "base/exported.hpp"
#include "config/yaml.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads a study and, if it `extends` another, adds to that one.
///
/// Maps are joined key by key. Any other value takes the place of the other study's, and so does a
/// map with a `type`. Values keep their origin. The folder of changes (`directory`) is that of the
/// study that is extended, unless one of them gives another. Throws ConfigError.
std::unique_ptr<YamlNode> read_study_file(const std::filesystem::path& file);

}  // namespace internal
}  // namespace hypotrack::detail
