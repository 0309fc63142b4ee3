// Checks of OBJ files before their import.

#include "model/import/format.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(obj, "mesh") { check_mesh_format(scratch_file("mesh.obj", bytes)); }

}  // namespace hypotrack::fuzz
