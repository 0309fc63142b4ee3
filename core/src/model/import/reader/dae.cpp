#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/files.hpp"
#include "model/import/reader/surfaces.hpp"
#include "model/import/wire.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

using Xml = boost::property_tree::ptree;

/// Returns an attribute of an element; an empty text if there is none.
std::string attribute(const Xml& element, const std::string& name) {
  return element.get<std::string>("<xmlattr>." + name, "");
}

/// The settings of a COLLADA effect that assimp leaves out.
struct Effect {
  std::array<Wrap, 2> wrap{};
  std::string coordinates{};  // name of those of its picture
  bool glows = false;         // its emission is its only colour
  std::array<float, 3> emission{};
  std::vector<std::string> left_out{};
};

/// The effects of a COLLADA file by the materials that use them.
class Effects {
 public:
  explicit Effects(const Xml& root);

  /// Returns the effect of a material as assimp names it; null if there is none.
  const Effect* of(const std::string& material) const;
  /// Returns the set of texture coordinates of a material's picture, which its instances bind by
  /// name.
  unsigned set_of(const std::string& material) const;

 private:
  void find_sets(const Xml& element);

  std::map<std::string, Effect> of_materials_;
  std::map<std::string, std::string> names_;  // of materials, by their references
  std::map<std::string, unsigned> sets_;      // by the names of materials
};

Wrap wrap_named(const std::string& mode) {
  if (mode == "MIRROR") return Wrap::mirror;
  return mode == "CLAMP" || mode == "BORDER" ? Wrap::clamp : Wrap::repeat;
}

std::array<Wrap, 2> wrap_of(const std::string& sampler, const Xml& profile) {
  for (const auto& [name, parameter] : profile) {
    if (name != "newparam" || attribute(parameter, "sid") != sampler) continue;
    return {wrap_named(parameter.get<std::string>("sampler2D.wrap_s", "")),
            wrap_named(parameter.get<std::string>("sampler2D.wrap_t", ""))};
  }
  return {};
}

void read_technique(const Xml& technique, const Xml& profile, Effect& effect) {
  for (const auto& [shading, slots] : technique) {
    if (shading == "constant") effect.glows = true;
    if (shading != "constant" && shading != "lambert" && shading != "phong" && shading != "blinn")
      continue;
    for (const auto& [slot, content] : slots) {
      const std::string sampler = content.get<std::string>("texture.<xmlattr>.texture", "");
      if (slot == "diffuse" && !sampler.empty()) {
        effect.wrap = wrap_of(sampler, profile);
        effect.coordinates = content.get<std::string>("texture.<xmlattr>.texcoord", "");
      } else if (!sampler.empty()) {
        effect.left_out.push_back("<" + slot + "> texture");
      } else if (slot == "emission") {
        std::istringstream numbers(content.get<std::string>("color", "0 0 0"));
        for (float& number : effect.emission) numbers >> number;
      }
    }
  }
  if (!effect.glows && effect.emission != std::array<float, 3>{0, 0, 0})
    effect.left_out.push_back("<emission> (it adds no light)");
}

Effect read_effect(const Xml& from) {
  Effect effect;
  for (const auto& [name, profile] : from) {
    if (name != "profile_COMMON") {
      if (name.starts_with("profile_")) effect.left_out.push_back("<" + name + ">");
      continue;
    }
    for (const auto& [part, content] : profile)
      if (part == "technique") read_technique(content, profile, effect);
  }
  return effect;
}

Effects::Effects(const Xml& root) {
  std::map<std::string, Effect> effects;
  for (const auto& [library, content] : root) {
    if (library == "library_effects") {
      for (const auto& [name, effect] : content)
        if (name == "effect") effects["#" + attribute(effect, "id")] = read_effect(effect);
    }
  }
  for (const auto& [library, content] : root) {
    if (library != "library_materials") continue;
    for (const auto& [name, material] : content) {
      if (name != "material") continue;
      const std::string url = material.get<std::string>("instance_effect.<xmlattr>.url", "#");
      const std::string own = attribute(material, "name"), id = attribute(material, "id");
      const std::string name_of_assimp = own.empty() ? id : own;
      names_["#" + id] = name_of_assimp;
      of_materials_[name_of_assimp] = effects[url];
    }
  }
  find_sets(root);
}

const Effect* Effects::of(const std::string& material) const {
  const auto found = of_materials_.find(material);
  return found == of_materials_.end() ? nullptr : &found->second;
}

unsigned Effects::set_of(const std::string& material) const {
  const auto found = sets_.find(material);
  return found == sets_.end() ? 0 : found->second;
}

void Effects::find_sets(const Xml& element) {
  for (const auto& [name, child] : element) {
    if (name != "instance_material") {
      find_sets(child);
      continue;
    }
    const auto material = names_.find(attribute(child, "target"));
    if (material == names_.end()) continue;
    for (const auto& [kind, binding] : child) {
      if (kind == "bind_vertex_input" && attribute(binding, "input_semantic") == "TEXCOORD" &&
          attribute(binding, "semantic") == of_materials_[material->second].coordinates)
        sets_[material->second] = binding.get<unsigned>("<xmlattr>.input_set", 0);
    }
  }
}

using Names = std::set<std::string, std::less<>>;

/// Lists the elements that are not read, each kind once.
class Unread {
 public:
  explicit Unread(std::vector<std::string>& notes) : notes_(notes) {}

  void look_at(const Xml& root) {
    static const Names kSections = {"<xmlattr>",
                                    "<xmlcomment>",
                                    "asset",
                                    "scene",
                                    "extra",
                                    "library_cameras",
                                    "library_lights",
                                    "library_effects",
                                    "library_geometries",
                                    "library_images",
                                    "library_materials",
                                    "library_nodes",
                                    "library_visual_scenes",
                                    "library_controllers"};
    for (const auto& [section, content] : root) {
      const bool is_empty = content.empty();
      if (!kSections.contains(section) && !is_empty) tell("<" + section + ">");
      if (section == "library_geometries")
        for (const auto& [name, geometry] : content) look_at_geometry(geometry);
    }
    look_for_files(root);
  }

 private:
  void look_at_geometry(const Xml& geometry) {
    static const Names kRead = {"<xmlattr>", "<xmlcomment>", "source",    "vertices", "triangles",
                                "polygons",  "polylist",     "tristrips", "trifans",  "extra"};
    for (const auto& [kind, content] : geometry) {
      if (kind == "mesh") {
        for (const auto& [name, part] : content)
          if (!kRead.contains(name)) tell("<" + name + ">");
      } else if (kind != "<xmlattr>" && kind != "extra" && kind != "asset") {
        tell("<" + kind + ">");
      }
    }
  }

  void look_for_files(const Xml& element) {
    for (const auto& [name, child] : element) {
      if (name == "<xmlattr>") {
        const std::string url = child.get<std::string>("url", "#");
        if (!url.starts_with("#")) tell("the other file " + url);
      } else {
        look_for_files(child);
      }
    }
  }

  void tell(const std::string& what) {
    if (told_.insert(what).second) notes_.push_back("it has " + what + ", which is not read");
  }

  std::vector<std::string>& notes_;
  Names told_;
};

/// Throws if a list has more or fewer numbers than it says: assimp takes what there is.
void check_numbers(const Xml& element) {
  for (const auto& [name, child] : element) {
    check_numbers(child);
    if (name != "float_array") continue;
    const std::string& text = child.data();
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find_first_not_of(" \t\r\n", at)) != text.npos; ++found)
      at = std::min(text.find_first_of(" \t\r\n", at), text.size());
    if (const std::string count = attribute(child, "count"); count != std::to_string(found))
      throw std::runtime_error("the list '" + attribute(child, "id") + "' has " +
                               std::to_string(found) + " numbers, and its count says " + count +
                               ": the file is damaged");
  }
}

void check_asset(const Xml& root, Scene& out) {
  const std::string unit = root.get<std::string>("asset.unit.<xmlattr>.meter", "1");
  std::istringstream in(unit);
  double metres = 0;
  if (!(in >> metres) || !(metres > 0) || !std::isfinite(metres))
    throw std::runtime_error("its <unit meter=\"" + unit +
                             "\"> is no length of a metre's multiple");
  if (const std::string name = root.get<std::string>("asset.unit.<xmlattr>.name", "meter");
      !root.get_optional<std::string>("asset.unit.<xmlattr>.meter") && name != "meter")
    out.notes.push_back("its <unit name=\"" + name +
                        "\"> has no `meter`, so its coordinates are metres");
  const auto up = root.get_optional<std::string>("asset.up_axis");
  if (!up)
    out.notes.push_back(
        "it has no <up_axis>, which means Y_UP; that turns nothing, as in RViz: the coordinates "
        "are the file's");
  else if (up->find("Z_UP") == up->npos)
    out.notes.push_back("its <up_axis> " + *up +
                        " turns nothing, as in RViz: the coordinates are the file's");
}

}  // namespace

std::vector<PictureUse> convert_dae(const std::string& file, const aiScene& scene, Scene& out) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    if (scene.mMeshes[i]->HasBones())
      throw std::runtime_error("it has a skin, and DAE files are read as rigid meshes only");
    if (scene.mMeshes[i]->mNumAnimMeshes > 0)
      out.notes.push_back("the shapes that mesh '" + std::string(scene.mMeshes[i]->mName.C_Str()) +
                          "' changes to are not read");
  }
  std::istringstream text(read_whole(file).value_or(""));
  Xml tree;
  boost::property_tree::read_xml(text, tree);
  const Xml& root = tree.get_child("COLLADA");
  check_numbers(root);
  check_asset(root, out);
  Unread(out.notes).look_at(root);
  const Effects effects(root);
  std::vector<PictureUse> uses(out.materials.size());
  for (std::size_t i = 0; i < out.materials.size() && i < scene.mNumMaterials; ++i) {
    Material& material = out.materials[i];
    const Effect* effect = effects.of(material.name);
    uses[i] = {effects.set_of(material.name), true};
    if (!effect) continue;
    material.wrap = effect->wrap;
    if (effect->glows && material.texture.empty()) material.color = effect->emission;
    std::vector<std::string> left_out = effect->left_out;
    float opacity = 1;
    scene.mMaterials[i]->Get(AI_MATKEY_OPACITY, opacity);
    if (opacity < 1) left_out.push_back("<transparency> (it is opaque)");
    add_note(material, left_out, out);
  }
  return uses;
}

}  // namespace hypotrack::mesh_wire::internal
