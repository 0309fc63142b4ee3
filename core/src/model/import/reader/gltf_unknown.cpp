#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "model/import/reader/gltf.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

using KeySet = std::set<std::string_view>;

/// A kind of objects, and its keys in glTF 2.0 beside `name`, `extensions` and `extras`.
struct ObjectKind {
  std::string_view name;
  KeySet keys;
};

/// Collects keys that glTF 2.0 does not have, and extensions, of a file's objects.
class UnknownKeys {
 public:
  explicit UnknownKeys(GltfUnknown& out) : out_(out) {}

  void look_at_root(const Json& root) {
    const KeySet all = {"accessors",      "animations", "asset",     "bufferViews",
                        "buffers",        "cameras",    "images",    "extensionsRequired",
                        "extensionsUsed", "materials",  "meshes",    "nodes",
                        "samplers",       "scene",      "scenes",    "skins",
                        "textures",       "extras",     "extensions"};
    take_unknown(root, "", all);
    take_extensions(root);
    look_at(member(root, "asset"), {"asset", {"version", "minVersion", "generator", "copyright"}});
    look_at_lists(root);
    for (const Json& mesh : list(root, "meshes"))
      for (const Json& primitive : list(mesh, "primitives"))
        look_at(primitive,
                {"primitives", {"attributes", "indices", "material", "mode", "targets"}});
    for (const Json& material : list(root, "materials"))
      look_at(member(material, "pbrMetallicRoughness"),
              {"pbrMetallicRoughness",
               {"baseColorFactor", "baseColorTexture", "metallicFactor", "roughnessFactor",
                "metallicRoughnessTexture"}});
  }

 private:
  void look_at_lists(const Json& root) {
    const std::array<ObjectKind, 10> kinds = {
        {{"nodes",
          {"camera", "children", "skin", "matrix", "mesh", "rotation", "scale", "translation",
           "weights"}},
         {"meshes", {"primitives", "weights"}},
         {"accessors",
          {"bufferView", "byteOffset", "componentType", "normalized", "count", "type", "max", "min",
           "sparse"}},
         {"bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride", "target"}},
         {"buffers", {"uri", "byteLength"}},
         {"images", {"uri", "mimeType", "bufferView"}},
         {"textures", {"sampler", "source"}},
         {"samplers", {"magFilter", "minFilter", "wrapS", "wrapT"}},
         {"skins", {"inverseBindMatrices", "skeleton", "joints"}},
         {"scenes", {"nodes"}}}};
    for (const ObjectKind& kind : kinds)
      for (const Json& object : list(root, std::string(kind.name).c_str())) look_at(object, kind);
    const ObjectKind materials{
        "materials",
        {"pbrMetallicRoughness", "normalTexture", "occlusionTexture", "emissiveTexture",
         "emissiveFactor", "alphaMode", "alphaCutoff", "doubleSided"}};
    // Their extensions have a note per material.
    for (const Json& material : list(root, "materials")) take_unknown(material, materials);
  }

  void look_at(const Json& object, const ObjectKind& kind) {
    take_unknown(object, kind);
    take_extensions(object);
  }

  void take_unknown(const Json& object, ObjectKind kind) {
    kind.keys.insert({"name", "extensions", "extras"});
    take_unknown(object, std::string(kind.name) + ".", kind.keys);
  }

  void take_unknown(const Json& object, const std::string& where, const KeySet& known) {
    if (!object.is_object()) return;
    for (const auto& [key, value] : object.items())
      if (!known.contains(key)) out_.keys.insert(where + key);
  }

  void take_extensions(const Json& object) {
    const Json& extensions = member(object, "extensions");
    if (!extensions.is_object()) return;
    for (const auto& [key, value] : extensions.items()) out_.extensions.insert(key);
  }

  GltfUnknown& out_;
};

}  // namespace

GltfUnknown unknown_in(const Json& root) {
  GltfUnknown out;
  UnknownKeys(out).look_at_root(root);
  return out;
}

}  // namespace hypotrack::mesh_wire::internal
