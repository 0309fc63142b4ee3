#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "model/import/reader/glb_builder.hpp"

namespace hypotrack::mesh_wire {
inline namespace HYPOTRACK_EXPORTED internal {

/// Copies the meshes of a glTF file with positions, texture coordinates, colours, weights and
/// indices that assimp reads right. Morph targets move the positions by the weights of their mesh.
/// Leaves out other attributes, points and lines.
class GltfMeshes {
 public:
  GltfMeshes(GltfFile& file, GlbBuilder& to) : file_(file), to_(to) {}

  /// Copies the meshes of `root`, with positions times a scale per mesh. Throws
  /// std::runtime_error.
  void copy(Json& root, const std::vector<double>& scales);

 private:
  /// An accessor of the new file.
  struct Copied {
    std::size_t index, width, count;
  };

  void copy_primitive(Json& primitive, const std::vector<double>& weights, double scale,
                      const std::string& name);
  Copied copy_positions(const Json& primitive, const Json& targets,
                        const std::vector<double>& weights, double scale, const std::string& name);
  void add_targets(const Json& targets, const std::vector<double>& weights, GltfValues& positions,
                   const std::string& name);
  void copy_indices(Json& primitive, std::size_t vertices, const std::string& name);
  void copy_influences(const Json& from, std::size_t vertices, const std::string& name, Json& to);
  void keep_draco(Json& primitive, const std::string& name);
  const Copied& floats(const Json& index, const std::vector<std::size_t>& widths,
                       std::size_t vertices, const std::string& what, double scale = 1);

  GltfFile& file_;
  GlbBuilder& to_;
  std::map<std::pair<std::uint64_t, double>, Copied> copied_;  // by old index and scale
  std::uint64_t triangles_ = 0, lost_triangles_ = 0;
};

}  // namespace internal
}  // namespace hypotrack::mesh_wire
