#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace hypotrack {

/// What the header of a PLY file (Turk 1994) says of the rest.
struct PlyHeader {
  std::string problem;  ///< in words, if this is no such header; then nothing else is known
  bool is_text = false;
  std::string elements;     ///< "8 vertex, 12 face"
  std::uint64_t count = 0;  ///< of all elements; in a text each has a line
  std::uint64_t least = 0;  ///< bytes that they take at least, in a binary file
};

/// Reads up to and with the line `end_header`.
PlyHeader read_ply_header(std::istream& in);

}  // namespace hypotrack
