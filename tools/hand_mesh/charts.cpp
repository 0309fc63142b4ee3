#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

#include "unwrap.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;

constexpr int kPalm = kDigits;  ///< as a region, after the digits
constexpr int kCut = kDigits + 1;
/// Smaller patches join a neighbour.
constexpr size_t kSmallestChart = 25;

/// Digit, palm or cut that a triangle lies in, times two, plus one on the dorsal side.
int raw_label(const TriangleMesh& mesh, const std::vector<VertexWeights>& weights,
              const std::vector<SkeletonBone>& skeleton, const Triangle& t) {
  const Vector3d normal = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                              .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                              .normalized();
  if (normal.y() < -0.75 && mesh.vertices[t[0]].y() < -0.5 * kStumpLength) return 2 * kCut;
  std::array<double, kDigits + 1> share{};
  Vector3d palmar = Vector3d::Zero();
  for (int v : t)
    for (int i = 0; i < 4; ++i) {
      const int bone = weights[v].bones[i];
      const int k = (bone - 1) % kBonesPerDigit, digit = (bone - 1) / kBonesPerDigit;
      const bool free = bone > 0 && k >= (digit == kThumb ? 2 : 1);
      share[free ? digit : kPalm] += weights[v].weights[i];
      palmar += weights[v].weights[i] *
                (free ? skeleton[bone].hand_from_bone.linear().col(2) : Vector3d(0, 0, 1));
    }
  const int region = static_cast<int>(std::max_element(share.begin(), share.end()) - share.begin());
  return 2 * region + (normal.dot(palmar) < 0 ? 1 : 0);
}

/// The triangle across each edge.
std::vector<Triangle> adjacency(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> owner;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      owner[{mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]}] = static_cast<int>(t);
  std::vector<Triangle> across(mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      across[t][i] = owner.at({mesh.triangles[t][(i + 1) % 3], mesh.triangles[t][i]});
  return across;
}

/// A triangle with two neighbours of another chart joins them: seams without teeth.
void smooth_seams(const std::vector<Triangle>& across, std::vector<int>& labels) {
  for (int round = 0; round < 20; ++round) {
    bool changed = false;
    for (size_t t = 0; t < labels.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const int a = labels[across[t][i]], b = labels[across[t][(i + 1) % 3]];
        if (a == b && a != labels[t]) {
          labels[t] = a;
          changed = true;
        }
      }
    if (!changed) return;
  }
}

/// Gives every connected patch of one label its own number.
std::vector<std::vector<int>> patches(const std::vector<Triangle>& across,
                                      const std::vector<int>& labels) {
  std::vector<std::vector<int>> found;
  std::vector<bool> seen(labels.size(), false);
  for (size_t start = 0; start < labels.size(); ++start) {
    if (seen[start]) continue;
    std::vector<int> patch{static_cast<int>(start)};
    seen[start] = true;
    for (size_t i = 0; i < patch.size(); ++i)
      for (int u : across[patch[i]])
        if (!seen[u] && labels[u] == labels[start]) {
          seen[u] = true;
          patch.push_back(u);
        }
    found.push_back(std::move(patch));
  }
  return found;
}

/// The label that a patch has the longest border with.
int neighbour_label(const std::vector<Triangle>& across, const std::vector<int>& labels,
                    const std::vector<int>& patch) {
  std::map<int, int> borders;
  for (int t : patch)
    for (int u : across[t])
      if (labels[u] != labels[t]) ++borders[labels[u]];
  return std::max_element(borders.begin(), borders.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

}  // namespace

std::vector<int> chart_labels(const TriangleMesh& mesh, const std::vector<VertexWeights>& weights,
                              const std::vector<SkeletonBone>& skeleton) {
  const std::vector<Triangle> across = adjacency(mesh);
  std::vector<int> labels;
  for (const Triangle& t : mesh.triangles) labels.push_back(raw_label(mesh, weights, skeleton, t));
  smooth_seams(across, labels);
  for (const std::vector<int>& patch : patches(across, labels))
    if (patch.size() < kSmallestChart) {
      const int label = neighbour_label(across, labels, patch);
      for (int t : patch) labels[t] = label;
    }
  smooth_seams(across, labels);
  const std::vector<std::vector<int>> final_patches = patches(across, labels);
  for (size_t i = 0; i < final_patches.size(); ++i)
    for (int t : final_patches[i]) labels[t] = static_cast<int>(i);
  return labels;
}

}  // namespace hypotrack::hand_mesh
