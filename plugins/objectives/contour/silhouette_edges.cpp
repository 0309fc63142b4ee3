#include "silhouette_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace hypotrack::contour {
namespace {

constexpr float kSharp = 0.9f;       // cosine of 25 degrees: finer tessellations are smooth
constexpr float kBeforeEye = 1e-3f;  // metres from the camera
constexpr float kMostApart = 2;      // pixels from an edge
constexpr float kAligned = 0.35f;    // sine of 20 degrees between edge and outline

Eigen::Vector3f normal_of(const Mesh& mesh, Eigen::Index triangle) {
  const Eigen::Vector3i corner = mesh.triangles.col(triangle);
  const Eigen::Vector3f a = mesh.vertices.col(corner[0]);
  const Eigen::Vector3f normal =
      (mesh.vertices.col(corner[1]) - a).cross(mesh.vertices.col(corner[2]) - a);
  const float length = normal.norm();
  return length > 0 ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::Zero();
}

}  // namespace

SilhouetteEdges::SilhouetteEdges(const Mesh& mesh) {
  std::map<std::pair<int, int>, std::size_t> known;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3f normal = normal_of(mesh, t);
    if (normal.isZero()) continue;
    for (int i = 0; i < 3; ++i) {
      const int a = mesh.triangles(i, t), b = mesh.triangles((i + 1) % 3, t);
      const auto [place, is_new] = known.try_emplace(std::minmax(a, b), edges_.size());
      if (is_new) {
        edges_.push_back(
            {mesh.vertices.col(a), mesh.vertices.col(b), {normal, Eigen::Vector3f::Zero()}, false});
        continue;
      }
      Edge& edge = edges_[place->second];
      edge.normals[1] = normal;
      edge.sharp = edge.normals[0].dot(normal) < kSharp;
    }
  }
}

void SilhouetteEdges::see(const Camera& camera) {
  seen_.clear();
  const Eigen::Isometry3f camera_from_model = camera.camera_from_world.cast<float>();
  const Eigen::Vector3f eye = camera_from_model.inverse().translation();
  const auto project = [&](const Eigen::Vector3f& p) {
    return Eigen::Vector2f(
        static_cast<float>(camera.fx) * p.x() / p.z() + static_cast<float>(camera.cx),
        static_cast<float>(camera.fy) * p.y() / p.z() + static_cast<float>(camera.cy));
  };
  for (const Edge& edge : edges_) {
    const Eigen::Vector3f to_eye = eye - edge.from;
    const bool first = edge.normals[0].dot(to_eye) > 0;
    const bool second = edge.normals[1].dot(to_eye) > 0;
    if (!edge.normals[1].isZero() && first == second) continue;
    const Eigen::Vector3f from = camera_from_model * edge.from, to = camera_from_model * edge.to;
    if (!(from.z() > kBeforeEye) || !(to.z() > kBeforeEye)) continue;
    seen_.push_back({project(from), project(to), from.z(), to.z(), &edge, first});
  }
}

std::optional<EdgePoint> SilhouetteEdges::nearest(const Eigen::Vector2f& pixel,
                                                  const Eigen::Vector2f& normal) const {
  const SeenEdge* best = nullptr;
  float least = kMostApart, share = 0;
  for (const SeenEdge& one : seen_) {
    const Eigen::Vector2f along = one.to - one.from;
    const float square = along.squaredNorm();
    if (!(square > 0)) continue;
    const float t = std::clamp((pixel - one.from).dot(along) / square, 0.0f, 1.0f);
    const float distance = (pixel - one.from - t * along).norm();
    if (distance >= least || std::abs(along.dot(normal)) > kAligned * std::sqrt(square)) continue;
    best = &one;
    least = distance;
    share = t;
  }
  if (!best) return std::nullopt;
  const Edge& edge = *best->edge;
  // Equal steps in the picture are not equal along the edge.
  const float t = share * best->from_z / (share * best->from_z + (1 - share) * best->to_z);
  EdgePoint out{edge.from + t * (edge.to - edge.from), (edge.to - edge.from).normalized(),
                Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  if (edge.sharp) {
    out.front = edge.normals[best->first_is_front ? 0 : 1];
    out.back = edge.normals[best->first_is_front ? 1 : 0];
  }
  return out;
}

}  // namespace hypotrack::contour
