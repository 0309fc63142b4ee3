#pragma once

#include <hwy/aligned_allocator.h>

#include <cstdint>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "scene/bone_poser.hpp"
#include "scene/simd_kernels.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

using AlignedFloats = hwy::AlignedFreeUniquePtr<float[]>;

/// A scene in the vertex order and memory layout of the CPU renderer. All models' vertices are
/// consecutive. Skinned models come first, sorted by bones, then models that pose themselves, in
/// their own order. Each model fills whole blocks.
struct ScenePlan {
  /// A model that core skins.
  struct Skinned {
    BonePoser poser;
    int offset = 0;  ///< of its parameters in the state
    int dimension = 0;
    int first_bone = 0;  ///< index of its first matrix in the scene's
  };
  /// A model that poses itself.
  struct Posed {
    const Model* model = nullptr;
    int offset = 0;
    std::uint32_t first_vertex = 0;
  };

  /// The vertices of a model, including the padding of its last block.
  struct Part {
    const Scene::Item* item = nullptr;
    std::uint32_t first_vertex = 0;  ///< a multiple of kBlock
    std::uint32_t vertex_count = 0;
  };

  /// The meshes of the models, or what stands for them where hypotheses are scored.
  enum class Surface { whole, simplified };

  /// The scene must outlive the plan.
  explicit ScenePlan(const Scene& scene, Surface surface = Surface::whole);
  ScenePlan(const ScenePlan&) = delete;
  ScenePlan& operator=(const ScenePlan&) = delete;

  std::vector<Skinned> skinned;
  std::vector<Posed> posed;
  std::vector<Part> parts;  ///< in the order of their vertices
  SkinBlocks blocks;
  int bone_count = 0;
  std::uint32_t vertex_count = 0;      ///< a multiple of kBlock
  std::vector<std::uint32_t> corners;  ///< see TriangleRange
  std::vector<TriangleRange> ranges;
  std::uint32_t triangle_count = 0;

 private:
  const Mesh& mesh_of(const Model& model) const;
  void add_skinned(const Scene::Item& item);
  void add_posed(const Scene::Item& item);
  void add_part(const Scene::Item& item);
  void add_triangles(const Mesh& mesh, const std::vector<std::uint32_t>& new_index);
  void add_block(const Mesh& mesh, int first_bone, const int* vertices, int count);

  Surface surface_;
  std::vector<float> positions_, weights_;
  AlignedFloats aligned_positions_, aligned_weights_;
};

}  // namespace internal
}  // namespace hypotrack
