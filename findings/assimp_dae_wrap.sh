#!/usr/bin/env bash
# Models of robots and objects name how a texture goes on beyond its edges: repeated, mirrored or
# clamped. assimp does not read this from COLLADA files and calls every texture repeated, although
# it reads the same setting of glTF files. A tracker or renderer behind it compares colours that
# the object does not have, without any message.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need g++ 4:12
need libassimp-dev 5.2.5

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/box.dae" <<'DAE'
<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
  <library_images><image id="picture"><init_from>picture.png</init_from></image></library_images>
  <library_effects><effect id="paint"><profile_COMMON>
    <newparam sid="surface"><surface type="2D"><init_from>picture</init_from></surface></newparam>
    <newparam sid="sampler"><sampler2D><source>surface</source>
      <wrap_s>MIRROR</wrap_s><wrap_t>CLAMP</wrap_t></sampler2D></newparam>
    <technique sid="common"><lambert>
      <diffuse><texture texture="sampler" texcoord="uv"/></diffuse>
    </lambert></technique>
  </profile_COMMON></effect></library_effects>
  <library_materials>
    <material id="painted"><instance_effect url="#paint"/></material>
  </library_materials>
  <library_geometries><geometry id="shape"><mesh>
    <source id="points"><float_array id="p" count="9">0 0 0 1 0 0 0 1 0</float_array>
      <technique_common><accessor source="#p" count="3" stride="3"><param name="X" type="float"/>
        <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
    </source>
    <source id="places"><float_array id="t" count="6">0 0 2 0 0 2</float_array>
      <technique_common><accessor source="#t" count="3" stride="2"><param name="S" type="float"/>
        <param name="T" type="float"/></accessor></technique_common></source>
    <vertices id="corners"><input semantic="POSITION" source="#points"/></vertices>
    <triangles count="1" material="paint"><input semantic="VERTEX" source="#corners" offset="0"/>
      <input semantic="TEXCOORD" source="#places" offset="1" set="0"/><p>0 0 1 1 2 2</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="all"><node><instance_geometry url="#shape">
    <bind_material><technique_common><instance_material symbol="paint" target="#painted">
      <bind_vertex_input semantic="uv" input_semantic="TEXCOORD" input_set="0"/>
    </instance_material></technique_common></bind_material>
  </instance_geometry></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#all"/></scene>
</COLLADA>
DAE
cat >"$folder/main.cpp" <<'CODE'
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstdio>

int main(int, char** arguments) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(arguments[1], 0);
  if (!scene) return std::puts(importer.GetErrorString()), 1;
  const aiMaterial& material = *scene->mMaterials[scene->mMeshes[0]->mMaterialIndex];
  const auto name = [&](bool across) {
    int mode = aiTextureMapMode_Wrap;
    const aiReturn said =
        across ? material.Get(AI_MATKEY_MAPPINGMODE_U(aiTextureType_DIFFUSE, 0), mode)
               : material.Get(AI_MATKEY_MAPPINGMODE_V(aiTextureType_DIFFUSE, 0), mode);
    if (said != AI_SUCCESS) return "unknown";
    return mode == aiTextureMapMode_Mirror  ? "mirrored"
           : mode == aiTextureMapMode_Clamp ? "clamped"
                                            : "repeated";
  };
  aiString picture;
  material.GetTexture(aiTextureType_DIFFUSE, 0, &picture);
  std::printf("expected: %s is mirrored across and clamped along\n", picture.C_Str());
  std::printf("seen:     it is %s across and %s along\n", name(true), name(false));
  return *name(true) == 'r' && *name(false) == 'r' ? 0 : 1;
}
CODE
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" -lassimp
"$folder/main" "$folder/box.dae"
