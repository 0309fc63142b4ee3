#pragma once

#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns what is wrong if a PNG, JPEG, PGM or PPM file has more pixels, by its header, than are
/// read: a few bytes must not take gigabytes. Empty for other formats and for damaged headers.
std::string problem_of_size(std::string_view bytes);

/// A format of pictures that is not read.
struct UnreadFormat {
  std::string_view name;  ///< empty for all others
  bool misread = false;   ///< OpenCV decodes it to something else, and does not fail
};

/// Returns the format of pictures that are not read.
UnreadFormat unread_format(std::string_view bytes);

}  // namespace internal
}  // namespace hypotrack
