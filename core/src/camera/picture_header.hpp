#pragma once

#include <string>
#include <string_view>

namespace hypotrack {

/// Says that a PNG or JPEG file has more pixels than are read, by its header, so that a few bytes
/// do not take gigabytes. Empty if it has not, for other formats and for damaged headers.
std::string problem_of_size(std::string_view bytes);

}  // namespace hypotrack
