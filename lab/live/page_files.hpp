#pragma once

#include <map>
#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

struct PageFile {
  std::string type;  ///< MIME type
  std::string content;
};

/// Reads the page of the live view and all files that it names, by their address ("/live.js").
/// Throws DataError if one cannot be read.
std::map<std::string, PageFile> live_page_files();

}  // namespace internal
}  // namespace hypotrack
