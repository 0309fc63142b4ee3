#include "unwrap.hpp"

#include <algorithm>
#include <map>

#include "flatten.hpp"
#include "pack.hpp"

namespace hypotrack::hand_mesh {
namespace {

std::vector<Chart> cut(const TriangleMesh& mesh, const std::vector<int>& labels) {
  std::vector<Chart> charts(*std::max_element(labels.begin(), labels.end()) + 1);
  std::vector<std::map<int, int>> local(charts.size());
  for (size_t t = 0; t < labels.size(); ++t) {
    Chart& chart = charts[labels[t]];
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
      const int v = mesh.triangles[t][i];
      const auto [entry, added] =
          local[labels[t]].try_emplace(v, static_cast<int>(chart.vertices.size()));
      if (added) chart.vertices.push_back(v);
      triangle[i] = entry->second;
    }
    chart.triangles.push_back(triangle);
    chart.source.push_back(static_cast<int>(t));
  }
  return charts;
}

}  // namespace

TextureMap unwrap(const TriangleMesh& mesh, const std::vector<VertexWeights>& weights,
                  const std::vector<SkeletonBone>& skeleton) {
  std::vector<Chart> charts = cut(mesh, chart_labels(mesh, weights, skeleton));
  for (Chart& chart : charts) flatten(mesh, chart);
  TextureMap map;
  map.millimetres = 1.0 / pack(charts);
  map.triangles.resize(mesh.triangles.size());
  for (const Chart& chart : charts) {
    const int first = static_cast<int>(map.coordinates.size());
    for (size_t t = 0; t < chart.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) map.triangles[chart.source[t]][i] = first + chart.triangles[t][i];
    for (size_t v = 0; v < chart.vertices.size(); ++v) {
      // Seen in the texture, with v downwards, charts are then as from outside of the hand.
      map.coordinates.emplace_back(chart.flat[v].x(), 1 - chart.flat[v].y());
      map.vertex_of.push_back(chart.vertices[v]);
    }
  }
  return map;
}

}  // namespace hypotrack::hand_mesh
