#pragma once

#include <map>
#include <string>
#include <string_view>

namespace hypotrack::app {

/// Returns the files that a guide for authors shows, by name: its blocks ```` ```lang file=NAME
/// ````.
std::map<std::string, std::string> files_of_guide(std::string_view markdown);

/// Reads those of the installed guide. Throws DataError if there is none.
std::map<std::string, std::string> files_of_guide();

}  // namespace hypotrack::app
