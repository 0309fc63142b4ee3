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

/// A vertex's number as two floats, which stand in a normal's place. Newer versions of assimp sort
/// vertices by first use, and leave out those that no triangle uses.
struct VertexNumber {
  float low, high;

  explicit VertexNumber(std::size_t number)
      : low(static_cast<float>(number % kStep)), high(static_cast<float>(number / kStep)) {}
  template <class Normal>
  static std::size_t of(const Normal& normal) {
    return static_cast<std::size_t>(normal.x) + kStep * static_cast<std::size_t>(normal.y);
  }

 private:
  static constexpr std::size_t kStep = 1 << 16;
};

/// Copies the meshes of a glTF file with positions, texture coordinates, colours, weights and
/// indices that assimp reads right, and a VertexNumber in place of each normal. Morph targets move
/// the positions by the weights of their mesh. Leaves out other attributes, points and lines.
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
  std::size_t numbers(std::size_t vertices);
  void keep_draco(Json& primitive, const std::string& name);
  const Copied& floats(const Json& index, const std::vector<std::size_t>& widths,
                       std::size_t vertices, const std::string& what, double scale = 1);

  GltfFile& file_;
  GlbBuilder& to_;
  std::map<std::pair<std::uint64_t, double>, Copied> copied_;  // by old index and scale
  std::map<std::size_t, std::size_t> numbers_;                 // accessors by count of vertices
  std::uint64_t triangles_ = 0, lost_triangles_ = 0;
};

}  // namespace internal
}  // namespace hypotrack::mesh_wire
