#include "cuda/device_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluate/mesh_topology.hpp"
#include "evaluate/vertex_order.hpp"
#include "hypotrack/kinematics.hpp"

namespace hypotrack::cuda {
namespace {

/// A scene's models one after the other, on the host.
struct HostScene {
  std::vector<ModelLayout> models;
  std::vector<BoneLayout> bones;
  std::vector<Turn> turns;
  std::vector<VertexLayout> vertices;
  std::vector<PackedTriangle> triangles;

  void add(const Scene::Item& item);
  void add_bones(const Scene::Item& item);
  void add_vertices(const Mesh& mesh, const std::vector<int>& order, std::size_t first_bone);
  void add_triangles(const Mesh& mesh, const std::vector<int>& order, std::size_t first_vertex);
};

void store(const Eigen::Isometry3d& transform, float* matrix) {
  Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> out(matrix);
  out = transform.matrix().topRows<3>().cast<float>();
}

/// By the number of their bones, the largest first; among equals neighbours share bones.
std::vector<int> order_by_work(const Mesh& mesh) {
  std::vector<int> order = order_by_bones(mesh);
  const auto bones = [&](int v) { return (mesh.bone_weights.col(v).array() > 0).count(); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return bones(a) > bones(b); });
  return order;
}

void HostScene::add(const Scene::Item& item) {
  const std::size_t first_bone = bones.size(), first_vertex = vertices.size();
  const Mesh& mesh = item.model->data().mesh;
  const std::vector<int> order = order_by_work(mesh);
  add_bones(item);
  add_vertices(mesh, order, first_bone);
  add_triangles(mesh, order, first_vertex);
  models.push_back({item.offset, item.model->dimension()});
}

void HostScene::add_bones(const Scene::Item& item) {
  const ModelData& data = item.model->data();
  const auto bind = bind_transforms(data);
  const auto first = static_cast<int>(bones.size());
  for (std::size_t b = 0; b < data.bones.size(); ++b) {
    const Bone& bone = data.bones[b];
    BoneLayout out{};
    out.parent = bone.parent < 0 ? -1 : first + bone.parent;
    out.model = static_cast<int>(models.size());
    out.first_turn = static_cast<int>(turns.size());
    for (const BoneRotation& r : data.rotations) {
      if (r.bone != static_cast<int>(b)) continue;
      turns.push_back({{static_cast<float>(r.axis.x()), static_cast<float>(r.axis.y()),
                        static_cast<float>(r.axis.z())},
                       static_cast<float>(r.scale),
                       static_cast<float>(r.zero),
                       item.offset + r.parameter});
      ++out.turn_count;
    }
    store(bone.parent_from_bone, out.parent_from_bone);
    store(bind[b].inverse(), out.bone_from_model);
    bones.push_back(out);
  }
}

/// Weights in units of 1 / kWholeWeight that add up: the largest takes what rounding leaves over.
void quantize(const Eigen::Vector4f& weights, std::uint16_t* out) {
  int sum = 0;
  for (int k = 0; k < 4; ++k) {
    out[k] = static_cast<std::uint16_t>(std::lround(weights[k] * kWholeWeight));
    sum += out[k];
  }
  Eigen::Index largest = 0;
  weights.maxCoeff(&largest);
  out[largest] = static_cast<std::uint16_t>(out[largest] + kWholeWeight - sum);
}

void HostScene::add_vertices(const Mesh& mesh, const std::vector<int>& order,
                             std::size_t first_bone) {
  for (const int v : order) {
    VertexLayout vertex{};
    for (int i = 0; i < 3; ++i) vertex.position[i] = mesh.vertices(i, v);
    quantize(mesh.bone_weights.col(v), vertex.weight);
    for (int k = 0; k < 4; ++k) {
      const auto bone =
          static_cast<std::size_t>(vertex.weight[k] > 0 ? mesh.bone_indices(k, v) : 0);
      vertex.bone[k] = static_cast<std::uint8_t>(first_bone + bone);
    }
    vertices.push_back(vertex);
  }
}

void HostScene::add_triangles(const Mesh& mesh, const std::vector<int>& order,
                              std::size_t first_vertex) {
  std::vector<std::size_t> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[static_cast<std::size_t>(order[i])] = first_vertex + i;
  }
  const PackedTriangle two_sided = is_closed_outwards(mesh) ? 0 : 1;
  for (const auto& t : mesh.triangles.colwise()) {
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
    vertices += item.model->data().mesh.vertices.cols();
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
  HostScene host;
  for (const Scene::Item& item : scene.items()) host.add(item);
  layout_ = {scene.dimension(),
             static_cast<int>(host.models.size()),
             static_cast<int>(host.bones.size()),
             static_cast<int>(host.turns.size()),
             static_cast<int>(host.vertices.size()),
             static_cast<int>(host.triangles.size()),
             upload(models_, host.models),
             upload(bones_, host.bones),
             upload(turns_, host.turns),
             upload(vertices_, host.vertices),
             upload(triangles_, host.triangles)};
}

}  // namespace hypotrack::cuda
