#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/mesh_io.hpp"
#include "model/import/weld.hpp"
#include "model/import/wire.hpp"

// What import_mesh() does with a file that the reader program has read, one step after the other.
namespace hypotrack {

struct MeshFile {
  std::filesystem::path path;
  MeshImportOptions options;
  mesh_wire::Scene scene;

  /// Throws a DataError that begins with the path.
  [[noreturn]] void fail(const std::string& what) const;
};

/// All parts of a file one after the other, in metres, with the copies of vertices that it has.
struct Soup {
  Eigen::Matrix3Xf points;
  Eigen::Matrix3Xi triangles;
  std::vector<Eigen::Vector2f> uvs;                 // empty or one per point
  std::vector<std::vector<BoneWeight>> influences;  // one list per point; empty for a rigid mesh
};

/// Which points of a soup are one vertex, and which of its triangles are faces.
struct Welded {
  std::vector<int> same;       // per point: the point that stands for it (weld_points())
  std::vector<int> triangles;  // those with three different corners and an area
  std::vector<int> points;     // per vertex of the mesh: its point
  std::vector<int> vertex;     // per point that stands for itself: its vertex, or -1
};

std::vector<ImportedBone> convert_bones(const MeshFile& file);

/// Indices in range, everything finite, weights not negative.
void check_part(const MeshFile& file, const mesh_wire::MeshPart& part);

/// Checks every part, then lays them one after the other.
Soup join_parts(const MeshFile& file);

/// The vertices of a skinned mesh's part, which begins at the point `first`, are held by bones,
/// with weights that sum to 1.
void check_weight_sums(const MeshFile& file, const mesh_wire::MeshPart& part, const Soup& soup,
                       std::size_t first);

/// Vertices and triangles. Says in the answer which they were in the soup.
Welded fill_surface(const MeshFile& file, const Soup& soup, Mesh& mesh);

/// Bone influences: a welded vertex has the mean of its copies.
void fill_weights(const Soup& soup, const Welded& welded, Mesh& mesh);

/// Texture coordinates, each once.
void fill_uvs(const Soup& soup, const std::vector<int>& kept, Mesh& mesh);

/// Texture or colour. Takes the texture coordinates away again if there is no texture.
void fill_appearance(const MeshFile& file, Mesh& mesh);

}  // namespace hypotrack
