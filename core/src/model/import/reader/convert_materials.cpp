#include <assimp/material.h>

#include "model/import/reader/convert.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

Wrap convert_wrap(int mode) {
  return mode == aiTextureMapMode_Mirror                                    ? Wrap::mirror
         : mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? Wrap::clamp
                                                                            : Wrap::repeat;
}

PictureUse convert_material(const aiMaterial& material, Material& converted) {
  aiColor4D color(0.8f, 0.8f, 0.8f, 1.0f);
  if (material.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS) {
    material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  }
  converted.color = {color.r, color.g, color.b};
  converted.name = material.GetName().C_Str();
  PictureUse use;
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    aiString path;
    if (material.GetTexture(type, 0, &path) != aiReturn_SUCCESS) continue;
    converted.texture = path.C_Str();
    int set = 0, u = aiTextureMapMode_Wrap, v = aiTextureMapMode_Wrap;
    material.Get(AI_MATKEY_UVWSRC(type, 0), set);
    material.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), u);
    material.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), v);
    converted.wrap = {convert_wrap(u), convert_wrap(v)};
    use.set = static_cast<unsigned>(set);
    break;
  }
  return use;
}

Texture convert_texture(const aiTexture& texture) {
  Texture converted;
  const char* data = reinterpret_cast<const char*>(texture.pcData);
  if (texture.mHeight == 0) {
    converted.bytes.assign(data, texture.mWidth);
  } else {
    converted.width = texture.mWidth;
    converted.height = texture.mHeight;
    converted.bytes.assign(data, std::size_t{4} * texture.mWidth * texture.mHeight);
  }
  return converted;
}

}  // namespace

std::vector<PictureUse> convert_materials(const aiScene& scene, Scene& out) {
  std::vector<PictureUse> uses;
  for (unsigned i = 0; i < scene.mNumMaterials; ++i)
    uses.push_back(convert_material(*scene.mMaterials[i], out.materials.emplace_back()));
  for (unsigned i = 0; i < scene.mNumTextures; ++i) {
    out.textures.push_back(convert_texture(*scene.mTextures[i]));
  }
  return uses;
}

}  // namespace hypotrack::mesh_wire::internal
