// Checks of STL files before their import.

#include "model/import/format.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(stl, "mesh") { check_mesh_format(scratch_file("mesh.stl", bytes)); }

}  // namespace hypotrack::fuzz
