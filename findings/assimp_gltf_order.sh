#!/usr/bin/env bash
# Landmarks, weights and correspondences of a hand or object name vertices by their numbers in its glTF file.
# From version 5.4 on, assimp numbers the vertices of glTF meshes anew, in the order in which triangles first
# use them, also without any step of post-processing; 5.2 kept the file's order. A landmark or a label then
# lies on another part of the surface, without a message.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need g++ 4:14
need libassimp-dev 5.4.3

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# Two triangles. The x of each vertex is its number in the file.
cat >"$folder/main.cpp" <<'CODE'
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstdio>
#include <fstream>
#include <string>

int main(int, char** arguments) {
  const float positions[] = {0, 0, 0, 1, 0, 0, 2, 1, 0, 3, 1, 0};
  const unsigned short corners[] = {3, 2, 0, 2, 1, 0};
  const std::string folder = arguments[1];
  std::ofstream data(folder + "/mesh.bin", std::ios::binary);
  data.write(reinterpret_cast<const char*>(positions), sizeof positions);
  data.write(reinterpret_cast<const char*>(corners), sizeof corners);
  data.close();
  std::ofstream(folder + "/mesh.gltf") << R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [3, 1, 0]},
      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
    "buffers": [{"byteLength": 60, "uri": "mesh.bin"}]})";
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(folder + "/mesh.gltf", 0);
  if (!scene || scene->mMeshes[0]->mNumVertices != 4) return std::puts(importer.GetErrorString()), 1;
  const aiVector3D* read = scene->mMeshes[0]->mVertices;
  std::puts("expected: vertices 0 1 2 3, as in the file");
  std::printf("seen:     vertices %.0f %.0f %.0f %.0f\n", read[0].x, read[1].x, read[2].x, read[3].x);
  const bool anew = read[0].x == 3 && read[1].x == 2 && read[2].x == 0 && read[3].x == 1;
  return anew ? 0 : 1;
}
CODE
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" -lassimp
"$folder/main" "$folder"
