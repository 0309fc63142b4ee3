#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The header of a PLY file (Turk 1994).
struct PlyHeader {
  std::string problem;  ///< why the header is invalid; then nothing else is set
  bool is_text = false;
  bool has_strips = false;  ///< of triangles, of which the importer reads one each
  std::string elements;     ///< "8 vertex, 12 face"
  std::string unread;       ///< elements and properties that are not read: "edge, vertex quality"
  std::uint64_t count = 0;  ///< number of all elements; a text file has one line for each
  std::uint64_t least = 0;  ///< least size of all elements in a binary file, bytes
};

/// Reads a header up to and including the line `end_header`.
PlyHeader read_ply_header(std::istream& in);

}  // namespace internal
}  // namespace hypotrack
