#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "model/import/weld.hpp"
#include "model/import/wire.hpp"

// import_mesh() after the reader program has read the file, and its steps in their order.
namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

inline constexpr double kFarthestPoint = 1e9;  ///< from the origin, along an axis, in metres

struct MeshFile {
  std::filesystem::path path;
  MeshImportOptions options;
  mesh_wire::Scene scene;

  /// Throws a DataError that begins with the path.
  [[noreturn]] void fail(const std::string& what) const;
};

/// All parts of a file concatenated, in metres, before vertices are welded.
struct Soup {
  Eigen::Matrix3Xf points;
  Eigen::Matrix3Xi triangles;
  std::vector<std::size_t> parts;                   // per triangle: its part of the file
  std::vector<Eigen::Vector2f> uvs;                 // empty or one per point; 0 in parts without
  std::vector<std::array<std::uint8_t, 3>> colors;  // RGB, one per point; white in parts without
  std::vector<std::vector<BoneWeight>> influences;  // one list per point; empty for a rigid mesh
};

/// The result of welding a soup: its vertices and non-degenerate triangles.
struct Welded {
  std::vector<int> same;       // per point: index of its representative (weld_points())
  std::vector<int> triangles;  // indices of the triangles with distinct corners and an area
  std::vector<int> points;     // per vertex of the mesh: index of its point
  std::vector<int> vertex;     // per representative point: index of its vertex, or -1
};

/// Makes the mesh and bones of what was read, by all steps below. Their notes and those of the
/// scene begin with the path. Throws DataError.
ImportedMesh convert_mesh(const MeshFile& file);

std::vector<ImportedBone> convert_bones(const MeshFile& file);

/// Throws DataError on indices out of range, numbers that are not finite, points far off and
/// negative weights.
void check_part(const MeshFile& file, const mesh_wire::MeshPart& part);

/// Checks every part and concatenates them.
Soup join_parts(const MeshFile& file);

/// Throws DataError unless bones move every vertex of a skinned part, with weights that sum to 1.
/// The part begins at point `first`.
void check_weight_sums(const MeshFile& file, const mesh_wire::MeshPart& part, const Soup& soup,
                       std::size_t first);

/// Fills the mesh's vertices and triangles and returns how they relate to the soup.
Welded fill_surface(const MeshFile& file, const Soup& soup, Mesh& mesh);

/// Fills the bone influences; a welded vertex has the mean of its copies' influences, which are
/// equal but for rounding. Copies that no triangle uses do not count.
void fill_weights(const Soup& soup, const Welded& welded, Mesh& mesh);

/// Sets the texture coordinates by those of every triangle's corners, without duplicates.
void set_uvs(const std::vector<Eigen::Matrix<float, 2, 3>>& corners, Mesh& mesh);

/// Returns the factor of a material on light, RGB in [0, 1].
Eigen::Vector3f light_factor(const mesh_wire::Material& material);

/// Returns the colour of a part's material, RGB in [0, 1]; NaN if there is none.
Eigen::Vector3f material_color(const MeshFile& file, const mesh_wire::MeshPart& part);

/// Fills the colour of the mesh, or its texture and texture coordinates: the colours and pictures
/// of all materials, times those of the points. `kept` are the triangles of the mesh.
/// `notes` receives what is not drawn as the file says.
void fill_appearance(const MeshFile& file, const Soup& soup, const std::vector<int>& kept,
                     Mesh& mesh, std::vector<std::string>& notes);

/// Reads an image as 8-bit BGR, not turned. Throws DataError if it is missing or damaged; `where`
/// names the user of the image in the message. `notes` receives what is not honoured.
cv::Mat read_texture(const std::filesystem::path& image, const std::string& where,
                     std::vector<std::string>& notes);

/// Loads the texture that a mesh file names: an embedded one (`*N`) or a file beside it.
cv::Mat load_texture(const mesh_wire::Scene& scene, const std::string& name,
                     const std::filesystem::path& mesh, std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack
