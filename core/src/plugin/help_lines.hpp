#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// A line of describe_params(): key, type and help, with two spaces or more between them.
struct HelpLine {
  std::size_t depth = 0;  ///< 0 for a parameter of the plugin itself
  std::string_view key, type, help;
};

/// Splits the text of describe_params() into its lines. They refer to the text.
std::vector<HelpLine> help_lines(std::string_view text);

}  // namespace internal
}  // namespace hypotrack::detail
