#pragma once

#include <string>

#include "hand_asset.hpp"

namespace hypotrack::hand_mesh {

/// The hand as a binary glTF 2.0 file (GLB): metres, hand frame, one skinned mesh with normals and
/// texture coordinates, the skeleton as a hierarchy of nodes under `wrist`, the texture as a PNG.
/// Vertices on seams of the texture map are doubled there, with equal positions and weights.
std::string to_glb(const HandAsset& hand);

}  // namespace hypotrack::hand_mesh
