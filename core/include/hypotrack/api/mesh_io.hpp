#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

class PluginContext;

/// A bone of a mesh file with its transform at the bind pose.
struct ImportedBone {
  std::string name;
  std::string parent;  ///< name of the nearest ancestor that is a bone; empty at the root
  Eigen::Isometry3d file_from_bone = Eigen::Isometry3d::Identity();  ///< bind pose, no scale
};

/// The mesh and bones of a file, in the file's axes, lengths multiplied by `scale`.
struct ImportedMesh {
  /// All meshes of the file; bone_indices refer to `bones`. Points in one place are welded if the
  /// same bones hold them by equal weights.
  Mesh mesh;
  std::vector<ImportedBone> bones;  ///< empty for a rigid mesh, whose weights are 4x0
  std::vector<std::string> notes;   ///< for the user: what the file has that is not used, and where
};

/// Options of import_mesh().
struct MeshImportOptions {
  double scale = 1.0;                  ///< metres per unit of the file
  std::filesystem::path texture = {};  ///< replaces the texture that the file names
};

/// Imports a DAE, OBJ, PLY, STL, glTF or GLB file. A child process with a time limit reads the
/// file, so that a damaged file cannot crash the program. Throws DataError on other formats, files
/// over 256 MiB, unreadable or damaged files, meshes without faces, NaN vertices or weights,
/// indices out of range, and skinned meshes with a vertex that no bone moves.
HYPOTRACK_API ImportedMesh import_mesh(const std::filesystem::path& file,
                                       const MeshImportOptions& options = {});

/// A mesh that a program holds, as import_mesh() reads it from a file.
struct MeshArrays {
  Eigen::Matrix3Xf vertices;   ///< 3xV, in any unit
  Eigen::Matrix3Xi triangles;  ///< 3xT vertex indices, counter-clockwise from outside
  /// 3xV, RGB of the vertices; 3x0: one colour for all.
  Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic> colors{3, 0};
};

/// Imports the mesh that a plugin's parameter names: a file, or `attached:NAME`, which the program
/// holds (SessionOptions::meshes). Throws ConfigError if it holds none of that name, else as above.
HYPOTRACK_API ImportedMesh import_mesh(const PluginContext& context,
                                       const std::filesystem::path& file,
                                       const MeshImportOptions& options = {});

/// Joins pictures into one texture, because a model has one. Equal pictures share a place.
class HYPOTRACK_API TextureAtlas {
 public:
  /// Adds an 8-bit BGR picture and returns the index of its place.
  std::size_t add(const cv::Mat& picture);
  /// Adds a colour, RGB in [0, 1], and returns the index of its place.
  std::size_t add(const Eigen::Vector3f& color);

  /// Returns the texture. Throws DataError, beginning with `where`, if it were too large.
  cv::Mat texture(const std::string& where);

  /// Moves texture coordinates (2xN, v upwards) from a picture to its place in texture(), which was
  /// called before.
  Eigen::Matrix2Xf moved(std::size_t index, const Eigen::Ref<const Eigen::Matrix2Xf>& uv) const;

 private:
  struct Place {
    int left = 0, top = 0, width = 0, height = 0;
  };
  std::vector<cv::Mat> pictures_;
  std::vector<Place> places_;
  int width_ = 0, height_ = 0;
};

}  // namespace hypotrack
