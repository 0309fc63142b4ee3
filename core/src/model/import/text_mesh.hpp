#pragma once

#include <istream>
#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Says what is wrong with an OBJ file that its importer would not notice: a number that is none, a
/// face of fewer than three corners, an index that names nothing. Begins with `line N: `; empty if
/// nothing is. `notes` receives the statements that are not read.
std::string problem_of_obj(std::istream& in, std::vector<std::string>& notes);

/// Says where an STL file of text departs from its grammar, as one does that was cut off. Begins
/// with `line N: `; empty if it does not.
std::string problem_of_text_stl(std::istream& in, std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack
