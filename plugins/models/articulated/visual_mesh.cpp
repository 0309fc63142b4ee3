#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <utility>

#include "description.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/media.hpp"
#include "hypotrack/api/mesh_io.hpp"
#include "surface.hpp"

namespace hypotrack::articulated {
namespace {

cv::Mat read_texture(const std::filesystem::path& file, const std::string& where) {
  cv::Mat picture;
  constexpr int kAsStored = cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION;
  if (std::filesystem::is_regular_file(file)) picture = read_image(file.string(), kAsStored);
  if (picture.empty())
    throw DataError(
        fmt::format("{}: its texture {} is missing or no image that OpenCV reads; name "
                    "a PNG or JPEG file, relative to the URDF file",
                    where, file.string()));
  return picture;
}

/// Scales a mesh along the axes. A mirror image keeps its outside outside.
void scale(Mesh& mesh, const Eigen::Vector3d& factors) {
  mesh.vertices = factors.cast<float>().asDiagonal() * mesh.vertices;
  if (factors.prod() > 0) return;
  mesh.triangles.row(1).swap(mesh.triangles.row(2));
  if (mesh.uv_triangles.cols() > 0) mesh.uv_triangles.row(1).swap(mesh.uv_triangles.row(2));
}

Mesh read_mesh(const Visual& visual, const std::string& where, const PluginLog& log) {
  Mesh mesh;
  try {
    ImportedMesh imported = import_mesh(visual.mesh, {.scale = 1, .texture = visual.texture});
    for (const std::string& note : imported.notes) log.note(note);
    mesh = std::move(imported.mesh);
  } catch (const DataError& error) {
    throw DataError(fmt::format("{}: {}", where, error.what()));
  }
  scale(mesh, visual.size);
  return mesh;
}

Mesh shape_of(const Visual& visual, const std::string& where, const PluginLog& log) {
  switch (visual.kind) {
    case ShapeKind::box:
      return box_mesh(visual.size);
    case ShapeKind::cylinder:
      return cylinder_mesh(visual.size[0], visual.size[1]);
    case ShapeKind::sphere:
      return sphere_mesh(visual.size[0]);
    case ShapeKind::mesh:
      break;
  }
  return read_mesh(visual, where, log);
}

/// Returns true for DAE meshes with colours: viewers of URDF files show theirs, not the visual's.
bool has_own_colors(const Visual& visual) {
  std::string type = visual.mesh.extension().string();
  std::ranges::transform(type, type.begin(), [](unsigned char c) { return std::tolower(c); });
  if (visual.kind != ShapeKind::mesh || type != ".dae") return false;
  const std::string text = read_whole(visual.mesh).value_or("");
  return text.find("instance_material") != text.npos || text.find("COLOR") != text.npos;
}

}  // namespace

Mesh visual_mesh(const Visual& visual, const std::string& where, const PluginLog& log) {
  const std::string here = where + ": " + visual.name;
  Mesh mesh = shape_of(visual, here, log);
  if (visual.kind != ShapeKind::mesh && !visual.texture.empty())
    mesh.texture = read_texture(visual.texture, here);
  if (mesh.texture.empty() && visual.color && !has_own_colors(visual)) mesh.color = *visual.color;
  mesh.vertices = visual.link_from_visual.cast<float>() * mesh.vertices;
  return mesh;
}

}  // namespace hypotrack::articulated
