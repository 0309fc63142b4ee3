#include "cost/cuda/draw/device_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hypotrack/gpu/skeleton.hpp"
#include "scene/mesh_topology.hpp"
#include "scene/quantized_weights.hpp"

namespace hypotrack::cuda::internal {
namespace {

/// The concatenated surfaces of a scene's models, on the host.
struct HostSurface {
  std::size_t bones = 0;
  std::vector<VertexLayout> vertices;
  std::vector<PackedTriangle> triangles;

  void add(const Model& model);
  void add_vertices(const Mesh& mesh, const std::vector<int>& order, std::size_t first_bone);
  void add_triangles(const Mesh& mesh, const std::vector<int>& order, std::size_t first_vertex);
};

/// Returns the vertices by falling number of bones; among equals, neighbours share bones.
std::vector<int> order_by_work(const Mesh& mesh) {
  std::vector<int> order = order_by_bones(mesh);
  const auto bones = [&](int v) { return (mesh.bone_weights.col(v).array() > 0).count(); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return bones(a) > bones(b); });
  return order;
}

void HostSurface::add(const Model& model) {
  const Mesh& mesh = simplified_mesh(model);
  const std::size_t first_vertex = vertices.size();
  const std::vector<int> order = order_by_work(mesh);
  add_vertices(mesh, order, bones);
  add_triangles(mesh, order, first_vertex);
  bones += model.data().bones.size();
}

void HostSurface::add_vertices(const Mesh& mesh, const std::vector<int>& order,
                               std::size_t first_bone) {
  for (const int v : order) {
    VertexLayout vertex{};
    for (int i = 0; i < 3; ++i) vertex.position[i] = mesh.vertices(i, v);
    const QuantizedWeights held = quantize_weights(mesh, v);
    for (std::size_t k = 0; k < 4; ++k) {
      vertex.weight[k] = held.weight[k];
      vertex.bone[k] =
          static_cast<std::uint8_t>(first_bone + static_cast<std::size_t>(held.bone[k]));
    }
    vertices.push_back(vertex);
  }
}

void HostSurface::add_triangles(const Mesh& mesh, const std::vector<int>& order,
                                std::size_t first_vertex) {
  std::vector<std::size_t> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[static_cast<std::size_t>(order[i])] = first_vertex + i;
  }
  const PackedTriangle two_sided = is_closed_outwards(mesh) ? 0 : 1;
  for (const int number : order_by_place(mesh)) {
    const auto t = mesh.triangles.col(number);
    PackedTriangle packed = two_sided << (3 * kVertexBits);
    for (int k = 0; k < 3; ++k) {
      packed |= PackedTriangle{place[static_cast<std::size_t>(t[k])]} << (k * kVertexBits);
    }
    triangles.push_back(packed);
  }
}

template <class T>
const T* upload(DeviceBuffer<T>& buffer, const std::vector<T>& from) {
  constexpr std::size_t kCopied = 16;  // bytes that kernels copy at a time
  buffer.reserve(from.size() + kCopied / sizeof(T) + 1);
  check(cudaMemcpy(buffer.data(), from.data(), from.size() * sizeof(T), cudaMemcpyHostToDevice),
        "uploading the scene");
  return buffer.data();
}

}  // namespace

std::string why_not_on_device(const Scene& scene) {
  Eigen::Index vertices = 0;
  std::size_t bones = 0;
  for (const Scene::Item& item : scene.items()) {
    if (item.model->poses_itself()) {
      return fmt::format("model '{}' poses itself, which only the CPU can do", item.name);
    }
    vertices += simplified_mesh(*item.model).vertices.cols();
    bones += item.model->data().bones.size();
  }
  if (vertices > kVertexMask) {
    return fmt::format("the models have {} vertices, at most {} fit", vertices, kVertexMask);
  }
  if (bones > kMostBones) {
    return fmt::format("the models have {} bones, at most {} fit", bones, kMostBones);
  }
  return {};
}

DeviceScene::DeviceScene(const Scene& scene) {
  if (const std::string why = why_not_on_device(scene); !why.empty()) {
    throw DeviceError("evaluate.backend: cuda: " + why + ". Write `backend: cpu`");
  }
  const Skeleton skeleton(scene);
  HostSurface surface;
  for (const Scene::Item& item : scene.items()) surface.add(*item.model);
  layout_ = {scene.dimension(),
             static_cast<int>(skeleton.models.size()),
             static_cast<int>(skeleton.bones.size()),
             static_cast<int>(skeleton.motions.size()),
             static_cast<int>(surface.vertices.size()),
             static_cast<int>(surface.triangles.size()),
             upload(models_, skeleton.models),
             upload(bones_, skeleton.bones),
             upload(motions_, skeleton.motions),
             upload(vertices_, surface.vertices),
             upload(triangles_, surface.triangles)};
}

}  // namespace hypotrack::cuda::internal
