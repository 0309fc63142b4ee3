#include <cmath>
#include <map>
#include <set>

#include "model/import/reader/gltf.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

std::set<std::size_t> joints_of(const Json& root) {
  std::set<std::size_t> joints;
  for (const Json& skin : list(root, "skins")) {
    for (const Json& joint : list(skin, "joints")) {
      item(root, "nodes", joint);
      joints.insert(static_cast<std::size_t>(whole(joint, "joints")));
    }
  }
  return joints;
}

}  // namespace

double take_scale(GltfValues& matrices) {
  const double* const m = matrices.numbers.data();
  const double volume = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
                        m[8] * (m[1] * m[6] - m[2] * m[5]);
  const double scale = std::cbrt(std::abs(volume));
  if (!std::isfinite(scale) || scale < 1e-12) return 1;
  for (std::size_t i = 0; i < matrices.numbers.size(); ++i)
    if (i % 16 < 12) matrices.numbers[i] /= scale;
  return scale;
}

std::vector<std::string> name_joints(Json& root) {
  const std::set<std::size_t> joints = joints_of(root);
  if (joints.empty()) return {};
  Json& nodes = root["nodes"];
  for (const std::size_t joint : joints)
    if (text(nodes[joint], "name").empty())  // the name that assimp would take
      nodes[joint]["name"] = "nodes[" + std::to_string(joint) + "]";
  std::set<std::string> all, of_joints, used;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    all.insert(text(nodes[i], "name"));
    if (joints.contains(i)) of_joints.insert(text(nodes[i], "name"));
  }
  std::map<std::string, std::size_t> copies;
  std::string renamed;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string name = text(nodes[i], "name");
    const bool joint = joints.contains(i);
    if (name.empty() || (joint ? used.insert(name).second : !of_joints.contains(name))) continue;
    std::string other;
    do {
      other = name + "_" + std::to_string(++copies.try_emplace(name, 1).first->second);
    } while (!all.insert(other).second);
    nodes[i]["name"] = other;
    if (joint) renamed += (renamed.empty() ? "" : ", ") + other;
  }
  if (renamed.empty()) return {};
  return {"several bones have one name; the later ones are read as " + renamed};
}

}  // namespace hypotrack::mesh_wire::internal
