#pragma once

#include <hwy/aligned_allocator.h>

#include <cstdint>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "scene/bone_poser.hpp"
#include "scene/simd_kernels.hpp"

namespace hypotrack {

using AlignedFloats = hwy::AlignedFreeUniquePtr<float[]>;

/// A scene in the order and layout that the CPU renderer works on. Vertices of all models lie one
/// after the other, first those that core skins, sorted by bones, then those of models that pose
/// themselves, in the models' own order; each model fills up whole blocks.
struct HYPOTRACK_API ScenePlan {
  /// A model whose vertices the skinning moves.
  struct Skinned {
    BonePoser poser;
    int offset = 0;  ///< in the state
    int dimension = 0;
    int first_bone = 0;  ///< in the scene's bone matrices
  };
  /// A model that poses itself.
  struct Posed {
    const Model* model = nullptr;
    int offset = 0;
    std::uint32_t first_vertex = 0;
  };

  /// Where the vertices of a model lie; the block that its last one lies in belongs to it as well.
  struct Part {
    const Scene::Item* item = nullptr;
    std::uint32_t first_vertex = 0;  ///< a multiple of kBlock
    std::uint32_t vertex_count = 0;
  };

  /// The scene must outlive the plan.
  explicit ScenePlan(const Scene& scene);
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
  void add_skinned(const Scene::Item& item);
  void add_posed(const Scene::Item& item);
  void add_part(const Scene::Item& item);
  void add_triangles(const Mesh& mesh, const std::vector<std::uint32_t>& new_index);
  void add_block(const Mesh& mesh, int first_bone, const int* vertices, int count);

  std::vector<float> positions_, weights_;
  AlignedFloats aligned_positions_, aligned_weights_;
};

}  // namespace hypotrack
