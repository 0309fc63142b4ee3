#pragma once

#include <string>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the head of an HTTP request, up to and with its empty line, with the fields only that
/// the live page uses. The others ask for what the page does not do: parts of a file (Range),
/// compression, forms. A body in an encoding is refused later, as it keeps no length.
std::string used_head(std::string_view head);

}  // namespace internal
}  // namespace hypotrack
