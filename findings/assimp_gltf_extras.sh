#!/usr/bin/env bash
# Programs may keep notes of their own under `extras` of any object of a glTF file, and glTF 2.0 allows any
# JSON value there, such as a number. assimp refuses the whole file if the value of a node is no object,
# although nothing of it is used. A mesh that every viewer shows then cannot be read, and a message about
# `extras` sends its owner to the wrong program.
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
cat >"$folder/main.cpp" <<'CODE'
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstdio>
#include <fstream>
#include <string>

int main(int, char** arguments) {
  const std::string folder = arguments[1];
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::ofstream(folder + "/mesh.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(positions), sizeof positions);
  Assimp::Importer importer;
  const auto is_read = [&](const std::string& extras) {
    std::ofstream(folder + "/mesh.gltf") << R"({"asset": {"version": "2.0"}, "scene": 0,
      "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "extras": )" << extras << R"(}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                     "min": [0, 0, 0], "max": [1, 1, 0]}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "mesh.bin"}]})";
    return importer.ReadFile(folder + "/mesh.gltf", 0) != nullptr;
  };
  const bool object = is_read("{\"id\": 7}"), number = is_read("7");
  std::puts("expected: read with extras {\"id\": 7} and with extras 7");
  std::printf("seen:     {\"id\": 7} is %s, 7 is %s: %s\n", object ? "read" : "refused",
              number ? "read" : "refused", importer.GetErrorString());
  return object && !number ? 0 : 1;
}
CODE
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" -lassimp
"$folder/main" "$folder"
