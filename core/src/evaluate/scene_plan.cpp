#include "evaluate/scene_plan.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "evaluate/mesh_topology.hpp"
#include "evaluate/vertex_order.hpp"
#include "hypotrack/kinematics.hpp"

namespace hypotrack {
namespace {

std::uint32_t round_up(std::size_t count) {
  return static_cast<std::uint32_t>((count + kBlock - 1) / kBlock * kBlock);
}

}  // namespace

ScenePlan::ScenePlan(const Scene& scene) {
  for (const Scene::Item& item : scene.items()) {
    if (!item.model->poses_itself()) add_skinned(item);
  }
  blocks.first_entry.push_back(static_cast<std::uint32_t>(blocks.bone.size()));
  aligned_entries_ = hwy::AllocateAligned<float>(std::max<std::size_t>(entries_.size(), 1));
  std::copy(entries_.begin(), entries_.end(), aligned_entries_.get());
  blocks.aligned_entries = aligned_entries_.get();
  entries_ = {};
  for (const Scene::Item& item : scene.items()) {
    if (item.model->poses_itself()) add_posed(item);
  }
}

void ScenePlan::add_skinned(const Scene::Item& item) {
  const ModelData& data = item.model->data();
  skinned.push_back({BonePoser(data), item.offset, item.model->dimension(), bone_count});
  const std::vector<int> order = order_by_bones(data.mesh);
  std::vector<std::uint32_t> new_index(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    new_index[static_cast<std::size_t>(order[i])] = vertex_count + static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = 0; i < order.size(); i += kBlock) {
    const std::size_t count = std::min<std::size_t>(kBlock, order.size() - i);
    add_block(data, bone_count, order.data() + i, static_cast<int>(count));
  }
  add_triangles(data.mesh, new_index);
  add_part(item);
  bone_count += static_cast<int>(data.bones.size());
}

void ScenePlan::add_block(const ModelData& data, int first_bone, const int* vertices, int count) {
  const Mesh& mesh = data.mesh;
  const auto bind = bind_transforms(data);
  const std::size_t first = blocks.bone.size();
  blocks.first_entry.push_back(static_cast<std::uint32_t>(first));
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 4; ++k) {
      const float weight = mesh.bone_weights(k, vertices[i]);
      if (weight == 0) continue;
      const int bone = mesh.bone_indices(k, vertices[i]);
      const auto wanted = static_cast<std::uint32_t>(first_bone + bone);
      const auto begin = blocks.bone.begin() + static_cast<std::ptrdiff_t>(first);
      const auto found = std::find(begin, blocks.bone.end(), wanted);
      const auto entry = static_cast<std::size_t>(found - blocks.bone.begin());
      if (found == blocks.bone.end()) {
        blocks.bone.push_back(wanted);
        entries_.resize(entries_.size() + 4 * kBlock, 0.0f);
      }
      const Eigen::Vector3d local = bind[static_cast<std::size_t>(bone)].inverse() *
                                    mesh.vertices.col(vertices[i]).cast<double>();
      float* lane = entries_.data() + entry * 4 * kBlock + i;
      for (int axis = 0; axis < 3; ++axis) {
        lane[axis * kBlock] += static_cast<float>(weight * local[axis]);
      }
      lane[3 * kBlock] += weight;
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
  const auto count = static_cast<std::size_t>(item.model->data().mesh.vertices.cols());
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

}  // namespace hypotrack
