#include "model/import/reader/gltf_skin.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace hypotrack::mesh_wire::internal {
namespace {

constexpr std::size_t kKept = 4;

using Influence = std::pair<double, double>;  // weight, joint

std::set<std::size_t> joints_of(const Json& root) {
  std::set<std::size_t> joints;
  for (const Json& skin : list(root, "skins")) {
    for (const Json& joint : list(skin, "joints")) {
      item(root, "nodes", joint);
      joints.insert(static_cast<std::size_t>(whole(joint, "joints")));
    }
  }
  return joints;
}

}  // namespace

GltfInfluences strongest_four(std::vector<GltfInfluences> sets) {
  if (sets.size() == 1) return std::move(sets.front());
  const std::size_t count = sets.front().weights.count();
  GltfInfluences kept{{kKept, std::vector<double>(kKept * count)},
                      {kKept, std::vector<double>(kKept * count)}};
  std::vector<Influence> all;
  for (std::size_t vertex = 0; vertex < count; ++vertex) {
    all.clear();
    double sum = 0, sum_of_kept = 0;
    for (const GltfInfluences& set : sets) {
      for (std::size_t k = kKept * vertex; k < kKept * (vertex + 1); ++k) {
        all.emplace_back(set.weights.numbers[k], set.joints.numbers[k]);
        sum += set.weights.numbers[k];
      }
    }
    std::ranges::stable_sort(all, [](const Influence& a, const Influence& b) {
      return (a.first > 0 ? a.first : 0) > (b.first > 0 ? b.first : 0);
    });
    for (std::size_t k = 0; k < kKept; ++k) sum_of_kept += all[k].first;
    const double factor = sum_of_kept > 0 && sum > 0 ? sum / sum_of_kept : 1;
    for (std::size_t k = 0; k < kKept; ++k) {
      kept.weights.numbers[kKept * vertex + k] = factor * all[k].first;
      kept.joints.numbers[kKept * vertex + k] = all[k].second;
    }
  }
  return kept;
}

double take_scale(GltfValues& matrices) {
  const double* const m = matrices.numbers.data();
  const double volume = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
                        m[8] * (m[1] * m[6] - m[2] * m[5]);
  const double scale = std::cbrt(std::abs(volume));
  if (!std::isfinite(scale) || scale < 1e-12) return 1;
  for (std::size_t i = 0; i < matrices.numbers.size(); ++i)
    if (i % 16 < 12) matrices.numbers[i] /= scale;
  return scale;
}

std::vector<std::string> name_joints(Json& root) {
  const std::set<std::size_t> joints = joints_of(root);
  if (joints.empty()) return {};
  Json& nodes = root["nodes"];
  for (const std::size_t joint : joints)
    if (text(nodes[joint], "name").empty())  // the name that assimp would take
      nodes[joint]["name"] = "nodes[" + std::to_string(joint) + "]";
  std::set<std::string> all, of_joints, used;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    all.insert(text(nodes[i], "name"));
    if (joints.contains(i)) of_joints.insert(text(nodes[i], "name"));
  }
  std::map<std::string, std::size_t> copies;
  std::string renamed;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string name = text(nodes[i], "name");
    const bool joint = joints.contains(i);
    if (name.empty() || (joint ? used.insert(name).second : !of_joints.contains(name))) continue;
    std::string other;
    do {
      other = name + "_" + std::to_string(++copies.try_emplace(name, 1).first->second);
    } while (!all.insert(other).second);
    nodes[i]["name"] = other;
    if (joint) renamed += (renamed.empty() ? "" : ", ") + other;
  }
  if (renamed.empty()) return {};
  return {"several bones have one name; the later ones are read as " + renamed};
}

}  // namespace hypotrack::mesh_wire::internal
