#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws DataError unless `file` exists, is at most 256 MiB and looks like OBJ, PLY, STL, DAE,
/// glTF or GLB. Checks the file name, the beginning and, for GLB, PLY and binary STL, the end. The
/// importer gets no other files. Returns notes on what the importer would leave out without a word.
std::vector<std::string> check_mesh_format(const std::filesystem::path& file);

/// Says what is wrong with an OBJ file that its importer would not notice: a number that is none, a
/// face of fewer than three corners, an index that names nothing. Begins with `line N: `; empty if
/// nothing is. `notes` receives the statements that are not read.
std::string problem_of_obj(std::istream& in, std::vector<std::string>& notes);

/// Says where an STL file of text departs from its grammar, as one does that was cut off. Begins
/// with `line N: `; empty if it does not.
std::string problem_of_text_stl(std::istream& in, std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack
