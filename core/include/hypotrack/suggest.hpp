#pragma once

#include <span>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Returns a hint for a message about an unknown word: "; did you mean 'particles'?", or an empty
/// text if no candidate is near. Counts insertions, deletions, substitutions and swaps of
/// neighbours (the Damerau-Levenshtein distance, optimal string alignment).
HYPOTRACK_API std::string did_you_mean(std::string_view word,
                                       std::span<const std::string> candidates);

}  // namespace hypotrack
