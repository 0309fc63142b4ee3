#include "model/import/reader/gltf.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>

#include "model/import/reader/gltf_meshes.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

class PlainWriter {
 public:
  explicit PlainWriter(const std::string& file) : file_(file) {}
  PlainGltf write();

 private:
  void part_meshes();
  bool is_quantized(const Json& mesh) const;
  void write_skins();
  void name_materials();
  void write_nodes();
  void write_scenes();

  GltfFile file_;
  Json root_;
  GlbBuilder glb_;
  std::map<std::size_t, std::size_t> skins_of_meshes_;
  std::vector<double> scales_;  // of the meshes' positions
};

/// Takes out what programs add for themselves, at any depth, which parse_gltf() limits. assimp
/// refuses values of it that are no objects, though glTF 2.0 allows them.
void erase_extras(Json& value) {
  if (value.is_object()) value.erase("extras");
  if (value.is_structured())
    for (Json& below : value) erase_extras(below);
}

/// Returns whether positions of a mesh are whole numbers.
bool PlainWriter::is_quantized(const Json& mesh) const {
  return std::ranges::any_of(list(mesh, "primitives"), [&](const Json& primitive) {
    const Json& index = member(member(primitive, "attributes"), "POSITION");
    const Json& type =
        index.is_null() ? index : member(item(root_, "accessors", index), "componentType");
    return !type.is_null() && type != kFloats;
  });
}

void PlainWriter::write_skins() {
  scales_.assign(root_["meshes"].size(), 1);
  std::map<std::size_t, std::vector<std::size_t>> meshes;  // of the skins that move quantised ones
  for (const auto& [mesh, skin] : skins_of_meshes_)
    if (is_quantized(root_["meshes"][mesh])) meshes[skin];
  for (const auto& [mesh, skin] : skins_of_meshes_)
    if (meshes.contains(skin)) meshes[skin].push_back(mesh);
  for (std::size_t number = 0; number < list(root_, "skins").size(); ++number) {
    Json& skin = root_["skins"][number];
    const std::size_t joints = list(skin, "joints").size();
    if (joints == 0) throw std::runtime_error("a skin has no joints");
    GltfValues matrices{16, {}};
    const Json& index = member(skin, "inverseBindMatrices");
    if (!index.is_null()) matrices = read_accessor(file_, index, {16}, "inverseBindMatrices");
    if (!index.is_null() && matrices.count() < joints)
      throw std::runtime_error("a skin has " + std::to_string(matrices.count()) +
                               " inverse bind matrices for " + std::to_string(joints) + " joints");
    while (matrices.count() < joints)  // they are the identity where none are given
      for (int k = 0; k < 16; ++k) matrices.numbers.push_back(k % 5 == 0 ? 1 : 0);
    if (const auto moved = meshes.find(number); moved != meshes.end()) {
      const double scale = take_scale(matrices);
      for (const std::size_t mesh : moved->second) scales_[mesh] = scale;
    }
    skin["inverseBindMatrices"] = glb_.add<float>(matrices, kFloats);
  }
}

/// Leaves assimp the materials' numbers as names. It sorts materials and pictures by first use and
/// does not read all kinds of pictures.
void PlainWriter::name_materials() {
  for (const char* key : {"images", "textures", "samplers"}) root_.erase(key);
  const std::size_t count = list(root_, "materials").size();
  for (std::size_t i = 0; i < count; ++i) root_["materials"][i] = {{"name", std::to_string(i)}};
}

/// Gives each skin that moves a mesh a copy of it, and each node that has its own weights of morph
/// targets: assimp has one mesh for all nodes.
void PlainWriter::part_meshes() {
  constexpr std::size_t kMostCopies = 1000;
  using Key = std::pair<std::uint64_t, std::vector<double>>;   // skin, weights
  std::map<std::uint64_t, std::map<Key, std::size_t>> copies;  // by mesh
  std::size_t made = 0;
  for (Json& node : root_["nodes"]) {
    if (member(node, "mesh").is_null()) continue;
    const std::uint64_t mesh = whole(node["mesh"], "mesh");
    auto& of_mesh = copies[mesh];
    const Json& original = item(root_, "meshes", node["mesh"]);
    const bool own = !list(node, "weights").empty();
    const Key key{whole(node, "skin", UINT64_MAX), morph_weights(own ? node : original)};
    if (key.first != UINT64_MAX) item(root_, "skins", node["skin"]);
    if (of_mesh.empty() && !own) of_mesh[key] = static_cast<std::size_t>(mesh);
    if (!of_mesh.contains(key)) {
      if (++made > kMostCopies) throw std::runtime_error("its meshes have too many skins");
      Json copy = original;
      copy["weights"] = key.second;
      root_["meshes"].push_back(std::move(copy));
      of_mesh[key] = root_["meshes"].size() - 1;
    }
    node["mesh"] = of_mesh[key];
    if (key.first != UINT64_MAX)
      skins_of_meshes_[of_mesh[key]] = static_cast<std::size_t>(key.first);
  }
}

void PlainWriter::write_nodes() {
  for (Json& node : root_["nodes"]) {
    node.erase("camera");
    node.erase("weights");
    if (member(node, "mesh").is_null()) continue;
    if (!list(item(root_, "meshes", node["mesh"]), "primitives").empty()) continue;
    node.erase("mesh");
    node.erase("skin");
  }
}

/// Adds a scene of all nodes to a file without scenes, which is a library of meshes.
void PlainWriter::write_scenes() {
  if (!list(root_, "scenes").empty()) {
    if (!member(root_, "scene").is_null()) item(root_, "scenes", root_["scene"]);
    return;
  }
  std::vector<bool> is_child(root_["nodes"].size());
  for (const Json& node : root_["nodes"]) {
    for (const Json& child : list(node, "children")) {
      item(root_, "nodes", child);
      is_child[static_cast<std::size_t>(whole(child, "children"))] = true;
    }
  }
  Json roots = Json::array();
  for (std::size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(i);
  root_["scenes"] = Json::array({{{"nodes", roots}}});
  root_["scene"] = 0;
}

PlainGltf PlainWriter::write() {
  check_gltf_support(file_.root());
  PlainGltf plain{"", gltf_notes(file_)};
  root_ = file_.root();
  erase_extras(root_);
  if (list(root_, "meshes").empty()) throw std::runtime_error("the file holds no mesh");
  if (list(root_, "nodes").empty()) throw std::runtime_error("the file holds no nodes");
  part_meshes();
  write_skins();
  GltfMeshes(file_, glb_).copy(root_, scales_);
  name_materials();
  write_nodes();
  write_scenes();
  for (std::string& note : name_joints(root_)) plain.notes.push_back(std::move(note));
  for (const char* key : {"animations", "cameras"}) root_.erase(key);
  plain.glb = std::move(glb_).finish(std::move(root_));
  return plain;
}

}  // namespace

PlainGltf plain_gltf(const std::string& file) {
  try {
    return PlainWriter(file).write();
  } catch (const Json::exception& error) {
    throw std::runtime_error(std::string("its JSON is not glTF: ") + error.what());
  }
}

}  // namespace hypotrack::mesh_wire::internal
