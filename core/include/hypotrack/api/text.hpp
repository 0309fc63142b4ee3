#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// Returns a text without blanks at both ends.
HYPOTRACK_API std::string_view trimmed(std::string_view text,
                                       std::string_view blanks = " \t\r\n\v\f");

/// Returns a text of a file for a message. Control characters become `?`. A text of more than
/// `most` bytes is cut between characters of UTF-8 and ends with `...`.
HYPOTRACK_API std::string printable(std::string_view text, std::size_t most = 60);

/// Returns a hint for a message about an unknown word: "; did you mean 'particles'?", or an empty
/// text if no candidate is near. Counts insertions, deletions, substitutions and swaps of
/// neighbours (the Damerau-Levenshtein distance, optimal string alignment).
HYPOTRACK_API std::string did_you_mean(std::string_view word,
                                       std::span<const std::string> candidates);

}  // namespace hypotrack
