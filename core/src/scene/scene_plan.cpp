#include "scene/scene_plan.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <set>
#include <utility>

#include "scene/mesh_topology.hpp"
#include "scene/quantized_weights.hpp"

namespace hypotrack::internal {
namespace {

std::uint32_t round_up(std::size_t count) {
  return static_cast<std::uint32_t>((count + kBlock - 1) / kBlock * kBlock);
}

AlignedFloats to_aligned(const std::vector<float>& from) {
  auto out = hwy::AllocateAligned<float>(std::max<std::size_t>(from.size(), 1));
  std::copy(from.begin(), from.end(), out.get());
  return out;
}

}  // namespace

ScenePlan::ScenePlan(const Scene& scene, Surface surface) : surface_(surface) {
  for (const Scene::Item& item : scene.items()) {
    if (!item.model->poses_itself()) add_skinned(item);
  }
  blocks.first_entry.push_back(static_cast<std::uint32_t>(blocks.bone.size()));
  aligned_positions_ = to_aligned(std::exchange(positions_, {}));
  aligned_weights_ = to_aligned(std::exchange(weights_, {}));
  blocks.aligned_positions = aligned_positions_.get();
  blocks.aligned_weights = aligned_weights_.get();
  blocks.weight_unit = 1.0f / cuda::kUnitWeight;
  for (const Scene::Item& item : scene.items()) {
    if (item.model->poses_itself()) add_posed(item);
  }
}

const Mesh& ScenePlan::mesh_of(const Model& model) const {
  return surface_ == Surface::whole ? model.data().mesh : simplified_mesh(model);
}

void ScenePlan::add_skinned(const Scene::Item& item) {
  const ModelData& data = item.model->data();
  const Mesh& mesh = mesh_of(*item.model);
  skinned.push_back({BonePoser(data), item.offset, item.model->dimension(), bone_count});
  const std::vector<int> order = order_by_bones(mesh);
  std::vector<std::uint32_t> new_index(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    new_index[static_cast<std::size_t>(order[i])] = vertex_count + static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = 0; i < order.size(); i += kBlock) {
    const std::size_t count = std::min<std::size_t>(kBlock, order.size() - i);
    add_block(mesh, bone_count, order.data() + i, static_cast<int>(count));
  }
  add_triangles(mesh, new_index);
  add_part(item);
  bone_count += static_cast<int>(data.bones.size());
}

void ScenePlan::add_block(const Mesh& mesh, int first_bone, const int* vertices, int count) {
  std::vector<QuantizedWeights> held;
  std::set<int> bones;
  const std::size_t at = positions_.size();
  positions_.resize(at + 3 * kBlock, 0.0f);
  for (int i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      positions_[at + static_cast<std::size_t>(axis * kBlock + i)] =
          mesh.vertices(axis, vertices[i]);
    }
    const QuantizedWeights& own = held.emplace_back(quantize_weights(mesh, vertices[i]));
    for (std::size_t k = 0; k < 4; ++k) {
      if (own.weight[k] > 0) bones.insert(own.bone[k]);
    }
  }
  blocks.first_entry.push_back(static_cast<std::uint32_t>(blocks.bone.size()));
  for (const int bone : bones) {
    blocks.bone.push_back(static_cast<std::uint32_t>(first_bone + bone));
    weights_.resize(weights_.size() + kBlock, 0.0f);
    float* lanes = weights_.data() + weights_.size() - kBlock;
    for (const QuantizedWeights& own : held) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (own.bone[k] == bone) *lanes += own.weight[k];
      }
      ++lanes;
    }
  }
}

void ScenePlan::add_posed(const Scene::Item& item) {
  const Mesh& mesh = item.model->data().mesh;
  posed.push_back({item.model.get(), item.offset, vertex_count});
  std::vector<std::uint32_t> new_index(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(new_index.begin(), new_index.end(), vertex_count);
  add_triangles(mesh, new_index);
  add_part(item);
}

void ScenePlan::add_part(const Scene::Item& item) {
  const auto count = static_cast<std::size_t>(mesh_of(*item.model).vertices.cols());
  parts.push_back({&item, vertex_count, static_cast<std::uint32_t>(count)});
  vertex_count += round_up(count);
}

void ScenePlan::add_triangles(const Mesh& mesh, const std::vector<std::uint32_t>& new_index) {
  TriangleRange range;
  range.begin = triangle_count;
  range.two_sided = !is_closed_outwards(mesh);
  for (const auto& t : mesh.triangles.colwise()) {
    for (const int v : t) corners.push_back(new_index[static_cast<std::size_t>(v)] * kRecord);
    corners.push_back(0);
  }
  // At least one degenerate triangle: three times the same corner.
  const auto count = static_cast<std::size_t>(mesh.triangles.cols()) + 1;
  triangle_count += round_up(count);
  corners.resize(std::size_t{triangle_count} * 4, new_index[0] * kRecord);
  range.end = triangle_count;
  ranges.push_back(range);
}

}  // namespace hypotrack::internal
