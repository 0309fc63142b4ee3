#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

/// A bone as the file has it: its node, parent node and transform at the bind pose.
struct ImportedBone {
  std::string name;
  std::string parent;  ///< name of the nearest ancestor that is a bone; empty at the root
  Eigen::Isometry3d file_from_bone = Eigen::Isometry3d::Identity();  ///< bind pose, no scale
};

/// What a mesh file holds, in the file's own frame times `scale`.
struct ImportedMesh {
  Mesh mesh;  ///< all meshes of the file joined, welded by position; bone_indices refer to `bones`
  std::vector<ImportedBone> bones;  ///< empty for a rigid mesh (weights are then 4x0)
};

struct MeshImportOptions {
  double scale = 1.0;                  ///< metres per unit of the file
  std::filesystem::path texture = {};  ///< image to use instead of the one that the file names
};

/// Reads OBJ, PLY, STL, glTF or GLB. The import runs in a child process with a time limit, so that
/// a damaged file cannot take the program down. Throws DataError on other formats, files over 256
/// MiB, unreadable or damaged files, no faces, NaN vertices or weights, indices out of range,
/// vertices of a skinned mesh that no bone holds.
HYPOTRACK_API ImportedMesh import_mesh(const std::filesystem::path& file,
                                       const MeshImportOptions& options = {});

}  // namespace hypotrack
