// Checks of PLY files before their import.

#include "model/import/format.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(ply, "mesh") { check_mesh_format(scratch_file("mesh.ply", bytes)); }

}  // namespace hypotrack::fuzz
