#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include "hypotrack/api/text.hpp"
#include "model/import/reader/gltf.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

enum class Support { read, invisible, replaceable, unread };

struct Extension {
  std::string_view name;
  Support support = Support::unread;
  std::string_view undo{};  // how to export a file without it
};

constexpr std::string_view kUndoMeshopt =
    "unpack it with `gltfpack -noq -kn -i FILE -o NEW.glb`, or export it again without -c and -cc";

/// The extensions of which more than the name is known. `invisible` ones change nothing that
/// hypotrack draws: it draws base colours in one light. `replaceable` ones are not read; a file
/// that does not require one has the same data without it.
constexpr std::array<Extension, 15> kExtensions = {{
    {"KHR_mesh_quantization", Support::read},
    {"KHR_draco_mesh_compression", Support::read},
    {"KHR_texture_transform", Support::read},
    {"KHR_materials_unlit", Support::read},
    {"KHR_materials_pbrSpecularGlossiness", Support::read},
    {"EXT_texture_webp", Support::read},
    {"KHR_lights_punctual", Support::invisible},
    {"KHR_materials_ior", Support::invisible},
    {"KHR_materials_variants", Support::invisible},
    {"KHR_xmp_json_ld", Support::invisible},
    {"KHR_animation_pointer", Support::invisible},
    {"EXT_meshopt_compression", Support::replaceable, kUndoMeshopt},
    {"KHR_meshopt_compression", Support::replaceable, kUndoMeshopt},
    {"KHR_texture_basisu", Support::replaceable,
     "export it again with PNG or JPEG textures (gltfpack without -tc)"},
    {"EXT_mesh_gpu_instancing", Support::unread,
     "export it again with one node per copy (gltfpack without -mi)"},
}};

const Extension* known_extension(std::string_view name) {
  const auto found = std::ranges::find(kExtensions, name, &Extension::name);
  return found == kExtensions.end() ? nullptr : &*found;
}

Support support_of(std::string_view name) {
  const Extension* known = known_extension(name);
  return known ? known->support : Support::unread;
}

/// Returns the texts of a list, for messages.
std::vector<std::string> texts(const Json& values) {
  std::vector<std::string> names;
  for (const Json& value : values)
    if (value.is_string()) names.push_back(value.get<std::string>());
  return names;
}

/// Joins texts with commas; counts those after the twentieth.
std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 20;
  std::string all;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i)
    all += (all.empty() ? "" : ", ") + printable(names[i]);
  return names.size() > kMost ? all + " and " + std::to_string(names.size() - kMost) + " others"
                              : all;
}

void add_count(std::size_t count, const char* what, const char* several,
               std::vector<std::string>& texts) {
  if (count > 0) texts.push_back(std::to_string(count) + " " + (count == 1 ? what : several));
}

/// Returns whether weights move morph targets at the start.
bool has_moved_targets(const Json& root) {
  const auto moves = [](const Json& object) {
    return std::ranges::any_of(morph_weights(object), [](double weight) { return weight != 0; });
  };
  return std::ranges::any_of(list(root, "meshes"), moves) ||
         std::ranges::any_of(list(root, "nodes"), moves);
}

/// Returns the names of meshes whose morph targets have what no step applies: colours and texture
/// coordinates, or positions beside compressed ones.
std::vector<std::string> meshes_of_odd_targets(const Json& root) {
  std::set<std::string> names;
  for (const Json& mesh : list(root, "meshes"))
    for (const Json& primitive : list(mesh, "primitives"))
      for (const Json& target : list(primitive, "targets"))
        for (const auto& [key, index] : target.items())
          if (key.starts_with("TEXCOORD_") || key.starts_with("COLOR_") ||
              (key == "POSITION" &&
               member(primitive, "extensions").contains("KHR_draco_mesh_compression")))
            names.insert(text(mesh, "name") + " (" + key + ")");
  return {names.begin(), names.end()};
}

/// Returns what a file has that changes the shape or the scene and is left out.
std::vector<std::string> left_out(const Json& root) {
  std::size_t targets = 0, flat = 0;
  const bool moved = has_moved_targets(root);
  for (const Json& mesh : list(root, "meshes")) {
    for (const Json& primitive : list(mesh, "primitives")) {
      targets += moved ? 0 : list(primitive, "targets").size();
      flat += whole(primitive, "mode", 4) < 4 ? 1 : 0;
    }
  }
  const Json& lights = member(member(root, "extensions"), "KHR_lights_punctual");
  const std::size_t scenes = list(root, "scenes").size();
  std::vector<std::string> texts;
  add_count(list(root, "animations").size(), "animation", "animations", texts);
  add_count(list(root, "cameras").size(), "camera", "cameras", texts);
  add_count(list(lights, "lights").size(), "light", "lights", texts);
  add_count(targets, "morph target (the base shape is read)",
            "morph targets (the base shape is read)", texts);
  add_count(flat, "set of points or lines", "sets of points or lines", texts);
  add_count(scenes > 1 ? scenes - 1 : 0, "further scene", "further scenes", texts);
  return texts;
}

/// Returns the attributes of vertices that no reader step knows. Names with `_` are a program's
/// own.
std::vector<std::string> unknown_attributes(const Json& root) {
  constexpr std::array<std::string_view, 4> kKnown = {"POSITION", "NORMAL", "TANGENT", "COLOR_0"};
  std::set<std::string> names;
  for (const Json& mesh : list(root, "meshes")) {
    for (const Json& primitive : list(mesh, "primitives")) {
      for (const auto& [name, index] : member(primitive, "attributes").items()) {
        const bool set = name.starts_with("TEXCOORD_") || name.starts_with("JOINTS_") ||
                         name.starts_with("WEIGHTS_") || name.starts_with("_");
        if (!set && std::ranges::find(kKnown, name) == kKnown.end()) names.insert(name);
      }
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace

void check_gltf_support(const Json& root) {
  const std::string version = text(member(root, "asset"), "version");
  if (!version.starts_with("2."))
    throw std::runtime_error("this is glTF version '" + printable(version) +
                             "'; hypotrack reads version 2: export the file as glTF 2.0");
  const std::string least = text(member(root, "asset"), "minVersion");
  if (!least.empty() && !least.starts_with("2.0"))
    throw std::runtime_error("it needs a reader of glTF version '" + printable(least) +
                             "'; hypotrack reads 2.0: export the file as glTF 2.0");
  for (const std::string& name : texts(list(root, "extensionsRequired"))) {
    if (support_of(name) == Support::read || support_of(name) == Support::invisible) continue;
    const Extension* known = known_extension(name);
    const std::string undo = known ? std::string(known->undo)
                                   : "export it again without it, for example with Blender, whose "
                                     "glTF files need no such extension";
    throw std::runtime_error("it requires the glTF extension " + printable(name) +
                             ", which hypotrack does not read; " + undo);
  }
}

std::vector<std::string> gltf_notes(const GltfFile& file) {
  std::vector<std::string> notes, unread;
  const GltfUnknown unknown = unknown_in(file.root());
  std::vector<std::string> used = texts(list(file.root(), "extensionsUsed"));
  for (const std::string& name : unknown.extensions)  // some files do not list theirs
    if (std::ranges::find(used, name) == used.end()) used.push_back(name);
  for (const std::string& name : used) {
    const bool of_materials = name.starts_with("KHR_materials_");  // there is a note per material
    if (support_of(name) == Support::unread && !of_materials) unread.push_back(name);
  }
  const auto add = [&](const char* heading, const std::vector<std::string>& names) {
    if (!names.empty()) notes.push_back(heading + joined(names));
  };
  add("glTF extensions that are not honoured: ", unread);
  add("left out: ", left_out(file.root()));
  if (has_moved_targets(file.root())) {
    notes.push_back(
        "morph targets: the shape is that of the file's weights, which stay as they are");
    add("morph targets that are not applied, of meshes: ", meshes_of_odd_targets(file.root()));
  }
  add("attributes of vertices that are not read: ", unknown_attributes(file.root()));
  add("keys that are not read: ", {unknown.keys.begin(), unknown.keys.end()});
  add("chunks that are not read: ", file.unknown_chunks());
  return notes;
}

}  // namespace hypotrack::mesh_wire::internal
