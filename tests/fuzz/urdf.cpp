// URDF files, without the meshes and pictures that they name.

#include "description.hpp"
#include "surface.hpp"
#include "target.hpp"

namespace hypotrack::fuzz {

HYPOTRACK_FUZZ_TARGET(urdf, "xml") {
  using namespace articulated;
  const Description description = read_urdf(scratch_file("it.urdf", bytes));
  const Assembly assembly = assemble(description.mechanism, "it.urdf");
  require(assembly.links.size() == description.mechanism.links.size(), "a link has no place");
  std::vector<Part> parts;
  for (Visual visual : description.visuals) {
    if (visual.kind == ShapeKind::mesh) continue;
    visual.texture.clear();
    parts.push_back({visual_mesh(visual, "it.urdf"), visual.link});
  }
  if (parts.empty()) return;
  ModelData data = assembly.data;
  data.mesh = join(parts, assembly, "it.urdf");
  const Model model(std::move(data));
}

}  // namespace hypotrack::fuzz
