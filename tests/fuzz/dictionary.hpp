#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hypotrack::fuzz {

/// Reads a dictionary of libFuzzer: lines of a quoted token, which \" \\ and \xNN escape. Throws
/// std::runtime_error on anything else.
std::vector<std::string> read_dictionary(std::string_view name);

}  // namespace hypotrack::fuzz
