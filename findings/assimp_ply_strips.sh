#!/usr/bin/env bash
# PLY files of scanned objects may hold their surface as strips of triangles, the element `tristrips`,
# in which every further index adds a triangle. assimp reads such a strip as one triangle or polygon and
# reports no error. A tracker or renderer behind it has an object with most of its surface missing.
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
cat >"$folder/strip.ply" <<'PLY'
ply
format ascii 1.0
element vertex 6
property float x
property float y
property float z
element tristrips 1
property list int int vertex_indices
end_header
0 0 0
0 1 0
1 0 0
1 1 0
2 0 0
2 1 0
6 0 1 2 3 4 5
PLY
cat >"$folder/main.cpp" <<'CODE'
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstdio>

int main(int, char** arguments) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(arguments[1], aiProcess_Triangulate);
  if (!scene) return std::puts(importer.GetErrorString()), 1;
  unsigned faces = 0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) faces += scene->mMeshes[i]->mNumFaces;
  std::puts("expected: a strip of six points has four triangles");
  std::printf("seen:     %u\n", faces);
  return faces < 4 ? 0 : 1;
}
CODE
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" -lassimp
"$folder/main" "$folder/strip.ply"
