#pragma once

#include <span>
#include <string_view>

#include "target.hpp"

namespace hypotrack::fuzz {

/// Writes the files that an input consists of into an emptied folder. A line `=== NAME` begins a
/// file. Leaves out names that are not among the known ones.
void write_parts(std::string_view bytes, const std::filesystem::path& folder,
                 std::span<const std::string_view> known);

}  // namespace hypotrack::fuzz
