#include "model/import/reader/dae_effects.hpp"

#include <sstream>

namespace hypotrack::mesh_wire::internal {
namespace {

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

}  // namespace

std::string attribute(const Xml& element, const std::string& name) {
  return element.get<std::string>("<xmlattr>." + name, "");
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

}  // namespace hypotrack::mesh_wire::internal
