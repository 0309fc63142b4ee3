#include <assimp/material.h>

#include "model/import/reader/convert.hpp"

namespace hypotrack::mesh_wire::internal {
namespace {

Material convert_material(const aiMaterial& material) {
  Material converted;
  aiColor4D color(0.8f, 0.8f, 0.8f, 1.0f);
  if (material.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS) {
    material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  }
  converted.color = {color.r, color.g, color.b};
  aiString path;
  if (material.GetTexture(aiTextureType_BASE_COLOR, 0, &path) == aiReturn_SUCCESS ||
      material.GetTexture(aiTextureType_DIFFUSE, 0, &path) == aiReturn_SUCCESS) {
    converted.texture = path.C_Str();
  }
  return converted;
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

void convert_materials(const aiScene& scene, Scene& out) {
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    out.materials.push_back(convert_material(*scene.mMaterials[i]));
  }
  for (unsigned i = 0; i < scene.mNumTextures; ++i) {
    out.textures.push_back(convert_texture(*scene.mTextures[i]));
  }
}

}  // namespace hypotrack::mesh_wire::internal
