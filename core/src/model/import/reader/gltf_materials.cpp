#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>

#include "model/import/reader/gltf_json.hpp"
#include "model/import/reader/surfaces.hpp"
#include "model/import/srgb.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

constexpr const char* kTransform = "KHR_texture_transform";
constexpr const char* kGlossiness = "KHR_materials_pbrSpecularGlossiness";

float number(const Json& value, float otherwise) {
  return value.is_number() ? value.get<float>() : otherwise;
}

template <std::size_t Size>
std::array<float, Size> numbers(const Json& values, float otherwise) {
  std::array<float, Size> out;
  for (std::size_t i = 0; i < Size; ++i)
    out[i] = values.is_array() && i < values.size() ? number(values[i], otherwise) : otherwise;
  return out;
}

/// The materials of a glTF file.
class GltfMaterials {
 public:
  GltfMaterials(GltfFile& file, Scene& out) : file_(file), json_(file.root()), out_(out) {}

  std::vector<PictureUse> convert() {
    const Json& materials = member(json_, "materials");
    std::vector<PictureUse> uses(out_.materials.size());
    for (std::size_t i = 0; i < uses.size(); ++i) {
      const std::string& name = out_.materials[i].name;
      std::size_t index = materials.size();
      std::from_chars(name.data(), name.data() + name.size(), index);
      if (index < materials.size()) uses[i] = convert(materials[index], index, out_.materials[i]);
    }
    return uses;
  }

 private:
  PictureUse convert(const Json& from, std::size_t index, Material& to) {
    to.name = member(from, "name").is_string() ? from.at("name").get<std::string>()
                                               : std::to_string(index);
    left_out_.clear();
    const Json& glossiness = member(member(from, "extensions"), kGlossiness);
    const bool has_glossiness = glossiness.is_object();
    const Json& surface = has_glossiness ? glossiness : member(from, "pbrMetallicRoughness");
    const Json* slot = &member(surface, has_glossiness ? "diffuseTexture" : "baseColorTexture");
    std::array<float, 3> factor =
        numbers<3>(member(surface, has_glossiness ? "diffuseFactor" : "baseColorFactor"), 1);
    choose_emission(from, slot, factor);
    PictureUse use;
    to.texture.clear();
    for (std::size_t c = 0; c < 3; ++c) {
      factor[c] = std::isfinite(factor[c]) ? std::clamp(factor[c], 0.0f, 1.0f) : 1;
      to.color[c] = srgb::encoded(factor[c]);
    }
    to.factor = factor;
    if (slot->is_object()) use = picture(*slot, to);
    list_other_pictures(from, surface, slot);
    list_extensions(from);
    list_alpha(from, surface, has_glossiness);
    add_note(to, left_out_, out_);
    return use;
  }

  /// Replaces a black base colour without picture by the emission. Otherwise lists the emission.
  void choose_emission(const Json& from, const Json*& slot, std::array<float, 3>& factor) {
    const std::array<float, 3> light = numbers<3>(member(from, "emissiveFactor"), 0);
    const auto is_black = [](const std::array<float, 3>& c) {
      return c == std::array<float, 3>{0, 0, 0};
    };
    if (is_black(light)) return;
    if (!is_black(factor)) {
      left_out_.push_back(member(from, "emissiveTexture").is_object()
                              ? "emissiveTexture (it adds no light)"
                              : "emissiveFactor (it adds no light)");
      return;
    }
    slot = &member(from, "emissiveTexture");
    factor = light;
    left_out_.push_back("its base colour is black, so its emission is its colour");
  }

  /// Sets the picture of a material by a glTF textureInfo.
  PictureUse picture(const Json& info, Material& to) {
    PictureUse use;
    const Json& transform = member(member(info, "extensions"), kTransform);
    const Json& own = member(transform, "texCoord");
    const Json& set = own.is_null() ? member(info, "texCoord") : own;
    if (!set.is_null()) use.set = static_cast<unsigned>(whole(set, "texCoord"));
    if (transform.is_object()) to.uv = transformed(transform);
    const Json& texture = element("textures", member(info, "index"));
    if (texture.is_null())
      throw std::runtime_error("material '" + to.name + "' names a texture that is not there");
    const Json& sampler = element("samplers", member(texture, "sampler"));
    to.wrap = {wrap(member(sampler, "wrapS")), wrap(member(sampler, "wrapT"))};
    to.texture = image_of(texture, to.name);
    return use;
  }

  const Json& element(const char* list, const Json& index) const {
    static const Json none;
    const Json& all = member(json_, list);
    if (index.is_null() || whole(index, list) >= all.size()) return none;
    return all[static_cast<std::size_t>(whole(index, list))];
  }

  static Wrap wrap(const Json& mode) {
    constexpr int kClamp = 33071, kMirror = 33648;
    const int value = mode.is_number_integer() ? mode.get<int>() : 0;
    return value == kClamp ? Wrap::clamp : value == kMirror ? Wrap::mirror : Wrap::repeat;
  }

  /// Returns the affine map of KHR_texture_transform for v upwards: offset, rotation against the
  /// clock, scale. The file has v downwards, so the map is put between two flips of v.
  static std::array<float, 6> transformed(const Json& transform) {
    const std::array<float, 2> offset = numbers<2>(member(transform, "offset"), 0);
    const std::array<float, 2> scale = numbers<2>(member(transform, "scale"), 1);
    const float angle = number(member(transform, "rotation"), 0);
    const float c = std::cos(angle), s = std::sin(angle);
    // Downwards: u' = a u + b v + e, v' = d u + f v + g. Upwards v becomes 1 - v on both sides.
    const float a = c * scale[0], b = s * scale[1], d = -s * scale[0], f = c * scale[1];
    return {a, -b, offset[0] + b, -d, f, 1 - offset[1] - f};
  }

  /// Returns the name of a texture's image: its path, or `*N` for the Nth image within the file.
  std::string image_of(const Json& texture, const std::string& material) {
    Json source = member(texture, "source");
    for (const char* other : {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds"}) {
      const Json& with = member(member(member(texture, "extensions"), other), "source");
      if (source.is_null() && !with.is_null()) {
        if (other != std::string("EXT_texture_webp"))
          throw std::runtime_error("the picture of material '" + material +
                                   "' is of the extension " + other +
                                   ": export it with PNG or JPEG pictures");
        source = with;
      }
    }
    const Json& image = element("images", source);
    if (image.is_null())
      throw std::runtime_error("the texture of material '" + material + "' has no image");
    const auto is_inside = [](const Json& one) {
      const Json& uri = member(one, "uri");
      return !uri.is_string() || uri.get_ref<const std::string&>().starts_with("data:");
    };
    if (!is_inside(image)) return decoded(member(image, "uri").get<std::string>());
    const auto [known, is_new] = textures_.emplace(whole(source, "source"), out_.textures.size());
    if (is_new) out_.textures.push_back({0, 0, file_.image(image)});
    return "*" + std::to_string(known->second);
  }

  /// Decodes the percent signs of a URI.
  static std::string decoded(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
      unsigned code = 0;
      const char* const digits = uri.data() + i + 1;
      if (uri[i] == '%' && i + 2 < uri.size() &&
          std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
        out += static_cast<char>(code);
        i += 2;
      } else {
        out += uri[i];
      }
    }
    return out;
  }

  void list_other_pictures(const Json& from, const Json& surface, const Json* used) {
    for (const Json* object : {&surface, &from}) {
      if (!object->is_object()) continue;
      for (const auto& [key, value] : object->items()) {
        if (!key.ends_with("Texture") || &value == used || key == "emissiveTexture") continue;
        left_out_.push_back(key);
      }
    }
  }

  void list_extensions(const Json& from) {
    const Json& extensions = member(from, "extensions");
    if (!extensions.is_object()) return;
    for (const auto& [key, value] : extensions.items())
      if (key != kGlossiness)
        left_out_.push_back(key == "KHR_materials_unlit" ? key + " (it is lit as all surfaces are)"
                                                         : key);
  }

  void list_alpha(const Json& from, const Json& surface, bool has_glossiness) {
    const Json& mode = member(from, "alphaMode");
    if (!mode.is_string() || mode == "OPAQUE") return;
    const float alpha =
        numbers<4>(member(surface, has_glossiness ? "diffuseFactor" : "baseColorFactor"), 1)[3];
    left_out_.push_back("alphaMode " + mode.get<std::string>() + " (it is opaque" +
                        (alpha < 1 ? ", not of alpha " + std::to_string(alpha).substr(0, 4) : "") +
                        ")");
  }

  GltfFile& file_;
  const Json& json_;
  Scene& out_;
  std::map<std::uint64_t, std::size_t> textures_;  // by image in the file
  std::vector<std::string> left_out_;              // of the material
};

}  // namespace

std::vector<PictureUse> convert_gltf_materials(GltfFile& file, Scene& out) {
  return GltfMaterials(file, out).convert();
}

}  // namespace hypotrack::mesh_wire::internal
