#pragma once

#include <string_view>

#include "base/exported.hpp"
#include "lab/study/study_file.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// The variant that every study has, for a look within minutes.
inline constexpr std::string_view kQuick = "quick";

/// Reduces a study to a few frames and seeds and to the ends of its axes of values. A study's own
/// variant of this name then changes what is not quick or not enough.
void make_quick(Study& study);

}  // namespace internal
}  // namespace hypotrack::study
