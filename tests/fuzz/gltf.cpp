// Checks of glTF and GLB files before their import, and the plain files that are made of them.

#include "model/import/reader/gltf.hpp"

#include "model/import/format.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {
namespace {

void check(const std::filesystem::path& file) {
  check_mesh_format(file);
  try {
    mesh_wire::plain_gltf(file.string());
  } catch (const std::exception& error) {  // the reading process tells it to ours
    throw DataError(error.what());
  }
}

}  // namespace

HYPOTRACK_FUZZ_TARGET(gltf, "mesh") {
  bool read = false;
  for (const char* name : {"mesh.gltf", "mesh.glb"})
    read |= attempt([&] { check(scratch_file(name, bytes)); });
  if (!read) throw DataError("neither glTF nor GLB");
}

}  // namespace hypotrack::fuzz
