#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Returns a text without blanks at both ends.
HYPOTRACK_API std::string_view trimmed(std::string_view text,
                                       std::string_view blanks = " \t\r\n\v\f");

/// Returns a text of a file for a message. Control characters become `?`. A text of more than
/// `most` bytes is cut between characters of UTF-8 and ends with `...`.
HYPOTRACK_API std::string printable(std::string_view text, std::size_t most = 60);

}  // namespace hypotrack
