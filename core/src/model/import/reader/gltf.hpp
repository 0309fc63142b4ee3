#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// A GLB file that assimp reads right, and what was left out of it.
struct PlainGltf {
  std::string glb;
  std::vector<std::string> notes;
};

/// Rewrites a glTF or GLB file as one GLB file without external buffers. Positions, texture
/// coordinates, colours and weights become floats, because assimp 5.2.5 takes the bits of other
/// numbers for floats. Every skin gets bind matrices, without which it crashes, and every joint a
/// name of its own. Throws std::exception on files that are damaged or require what is not read.
/// Part of the reader process.
PlainGltf plain_gltf(const std::string& file);

}  // namespace internal
}  // namespace hypotrack::mesh_wire
