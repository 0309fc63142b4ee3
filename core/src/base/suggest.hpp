#pragma once

#include <span>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack::detail {

/// Damerau-Levenshtein distance (optimal string alignment): insertions, deletions, substitutions
/// and swaps of neighbours.
HYPOTRACK_API int edit_distance(std::string_view a, std::string_view b);

/// "; did you mean 'particles'?", or nothing if no candidate is near.
HYPOTRACK_API std::string did_you_mean(std::string_view word,
                                       std::span<const std::string> candidates);

}  // namespace hypotrack::detail
