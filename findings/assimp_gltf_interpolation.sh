#!/usr/bin/env bash
# glTF says for each curve of a motion how it goes between its keys: in steps, in straight lines, or
# along cubic splines with given tangents. assimp reads all three as the same bare keys and has no
# field for the rest, so every reader behind it draws straight lines. A gripper that shuts at once
# closes slowly, and splines exported with few keys lose their shape between them without any
# message.
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
cat >"$folder/main.cpp" <<'END'
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

/// Writes a triangle that moves by three keys at 0, 1 and 2 seconds.
void write_motion(const std::string& folder, const std::string& interpolation) {
  std::vector<float> numbers{0, 0, 0, 1, 0, 0, 0, 1, 0};  // positions
  numbers.insert(numbers.end(), {0, 1, 2});               // times
  const bool cubic = interpolation == "CUBICSPLINE";
  for (const float key : {0.0f, 1.0f, 2.0f}) {
    if (cubic) numbers.insert(numbers.end(), {9, 9, 9});  // tangent into the key
    numbers.insert(numbers.end(), {key, 0, 0});
    if (cubic) numbers.insert(numbers.end(), {9, 9, 9});  // and out of it
  }
  std::ofstream(folder + "/motion.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(numbers.data()),
             static_cast<std::streamsize>(numbers.size() * sizeof(float)));
  const std::string keys = std::to_string(cubic ? 9 : 3),
                    bytes = std::to_string(numbers.size() * 4);
  std::ofstream(folder + "/motion.gltf")
      << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      << R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      << R"("buffers":[{"uri":"motion.bin","byteLength":)" << bytes
      << R"(}],"bufferViews":[{"buffer":0,"byteLength":36},)"
      << R"({"buffer":0,"byteOffset":36,"byteLength":12},{"buffer":0,"byteOffset":48,"byteLength":)"
      << (cubic ? 108 : 36) << R"(}],"accessors":[)"
      << R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
      << R"({"bufferView":1,"componentType":5126,"count":3,"type":"SCALAR","min":[0],"max":[2]},)"
      << R"({"bufferView":2,"componentType":5126,"count":)" << keys << R"(,"type":"VEC3"}],)"
      << R"("animations":[{"samplers":[{"input":1,"output":2,"interpolation":")" << interpolation
      << R"("}],"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}]})";
}

/// Returns the keys that assimp has of it.
std::string keys(const std::string& folder, const std::string& interpolation) {
  write_motion(folder, interpolation);
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(folder + "/motion.gltf", aiProcess_ValidateDataStructure);
  if (!scene || scene->mNumAnimations != 1) return importer.GetErrorString();
  const aiNodeAnim& curve = *scene->mAnimations[0]->mChannels[0];
  std::string text;
  for (unsigned i = 0; i < curve.mNumPositionKeys; ++i)
    text += std::to_string(static_cast<int>(curve.mPositionKeys[i].mTime)) +
            " ms: " + std::to_string(static_cast<int>(curve.mPositionKeys[i].mValue.x)) + "  ";
  return text;
}

int main(int, char** arguments) {
  const std::string step = keys(arguments[1], "STEP"), line = keys(arguments[1], "LINEAR"),
                    cubic = keys(arguments[1], "CUBICSPLINE");
  std::printf("expected: three motions that differ between their keys differ after import\n");
  std::printf("seen:     STEP         %s\n          LINEAR       %s\n          CUBICSPLINE  %s\n",
              step.c_str(), line.c_str(), cubic.c_str());
  return step == line && cubic == line && line == "0 ms: 0  1000 ms: 1  2000 ms: 2  " ? 0 : 1;
}
END
g++ -std=c++17 -O1 "$folder/main.cpp" -o "$folder/main" -lassimp
"$folder/main" "$folder"
