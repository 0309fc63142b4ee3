#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/config.hpp"

namespace hypotrack::calibration {
inline namespace HYPOTRACK_EXPORTED internal {

/// Paths of keys, whose parts '/' separates. `*` at the end of a part stands for any characters.
/// What a path names may be a matrix of OpenCV; `**` as the last part stands for everything below.
using KeyPaths = std::vector<std::string>;

/// Keys that a reader knows and does not use.
struct KnownButUnused {
  std::string why;  ///< `of the IMU`
  KeyPaths paths;
};

/// Appends paths that begin with each of some parts: `cam0/D` for `cam0` and `D`.
void append_below(std::initializer_list<std::string_view> parts,
                  std::initializer_list<std::string_view> keys, KeyPaths& paths);

/// Appends paths to others.
void append(const KeyPaths& paths, KeyPaths& to);

/// Returns the paths of the keys that read_size() takes, each after a prefix: `cam0/`.
KeyPaths size_keys(std::string_view prefix);

/// Adds one note that names every key of a file that is not used, and why. Adds none if all are.
void note_unused_keys(const ConfigNode& file, const std::string& file_name, const KeyPaths& used,
                      const std::vector<KnownButUnused>& unused, std::vector<std::string>& notes);

/// Returns the note on a list of names with their reason in brackets. Long lists are cut.
std::string unused_part(const std::vector<std::string>& names, std::string_view why);

}  // namespace internal
}  // namespace hypotrack::calibration
