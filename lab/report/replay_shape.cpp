#include <algorithm>
#include <cmath>

#include "hypotrack/plugin/kinematics.hpp"
#include "lab/json_file.hpp"
#include "lab/report/packed.hpp"
#include "lab/report/replay.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kMicrometre = 1e-6;

Json rounded(const Eigen::Vector3d& p) {
  Json json = Json::array();
  for (const double x : p) json.push_back(std::round(x / kMicrometre) * kMicrometre);
  return json;
}

/// Appends weights as bytes. Adjusts the largest so that the four sum to 255.
void append_weights(const Eigen::Vector4f& weights, std::vector<std::uint8_t>& bytes) {
  Eigen::Vector4i whole = (255 * weights).array().round().cast<int>();
  Eigen::Index largest = 0;
  weights.maxCoeff(&largest);
  whole[largest] += 255 - whole.sum();
  for (const int value : whole) bytes.push_back(static_cast<std::uint8_t>(value));
}

void add_mesh(const Mesh& mesh, Json& shape) {
  std::vector<double> positions(mesh.vertices.data(), mesh.vertices.data() + mesh.vertices.size());
  shape["vertices"] = pack_numbers(positions);
  std::vector<std::uint32_t> triangles(mesh.triangles.data(),
                                       mesh.triangles.data() + mesh.triangles.size());
  if (mesh.vertices.cols() < 65536) {
    const std::vector<std::uint16_t> small(triangles.begin(), triangles.end());
    shape["triangles"] = {{"bits", 16}, {"b", pack_words(small)}};
  } else {
    shape["triangles"] = {{"bits", 32}, {"b", pack_longs(triangles)}};
  }
  std::vector<std::uint16_t> bones(mesh.bone_indices.data(),
                                   mesh.bone_indices.data() + mesh.bone_indices.size());
  shape["bones"] = pack_words(bones);
  std::vector<std::uint8_t> weights;
  for (Eigen::Index v = 0; v < mesh.bone_weights.cols(); ++v)
    append_weights(mesh.bone_weights.col(v), weights);
  shape["weights"] = pack_bytes(weights);
}

}  // namespace

std::vector<std::pair<int, int>> skeleton_edges(const ModelData& data) {
  std::vector<std::vector<int>> on_bone(data.bones.size());
  for (std::size_t i = 0; i < data.landmarks.size(); ++i)
    on_bone[static_cast<std::size_t>(data.landmarks[i].bone)].push_back(static_cast<int>(i));
  const auto distance = [&](int landmark) {
    return data.landmarks[static_cast<std::size_t>(landmark)].position.norm();
  };
  std::vector<std::pair<int, int>> edges;
  for (std::size_t bone = 0; bone < on_bone.size(); ++bone) {
    std::vector<int>& here = on_bone[bone];
    std::stable_sort(here.begin(), here.end(),
                     [&](int a, int b) { return distance(a) < distance(b); });
    int above = data.bones[bone].parent;
    while (above >= 0 && on_bone[static_cast<std::size_t>(above)].empty())
      above = data.bones[static_cast<std::size_t>(above)].parent;
    // Start from the parent bone's landmark that is nearest its origin, where its children attach.
    int last = above < 0 ? -1 : on_bone[static_cast<std::size_t>(above)].front();
    for (const int landmark : here) {
      if (last >= 0) edges.emplace_back(last, landmark);
      last = landmark;
    }
  }
  return edges;
}

Json replay_shape(const Model& model) {
  const ModelData& data = model.data();
  Json shape;
  if (!model.poses_itself()) add_mesh(data.mesh, shape);
  const std::vector<Eigen::Isometry3d> bind = bind_transforms(data);
  shape["landmarks"] = Json::array();
  for (const Landmark& landmark : data.landmarks)
    shape["landmarks"].push_back(
        {{"name", landmark.name},
         {"bone", landmark.bone},
         {"p", rounded(bind[static_cast<std::size_t>(landmark.bone)] * landmark.position)}});
  shape["edges"] = Json::array();
  for (const auto& [from, to] : skeleton_edges(data)) shape["edges"].push_back({from, to});
  const Eigen::Vector3f color = data.mesh.color;
  shape["color"] = {color[0], color[1], color[2]};
  return shape;
}

}  // namespace hypotrack::internal
