#include "hand_shape.hpp"

#include <algorithm>

#include "extract.hpp"
#include "remesh.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;

/// Relative length of edges: 1 on the palm, about half of that where the surface bends more.
double edge_length(const std::vector<SkeletonBone>& skeleton, const Vector3d& p) {
  double length = 0.85 + 0.15 * smooth_step(-10, 15, p.y());
  for (int d = 0; d < kDigits; ++d)
    for (int k = d == kThumb ? 2 : 1; k < kBonesPerDigit; ++k) {
      const SkeletonBone& bone = skeleton[bone_index(d, k)];
      Vector3d local = bone.hand_from_bone.inverse() * p;
      const double joint = k > 1 ? local.norm() : 1e9;
      const double tip = k == 3 ? (local - Vector3d(0, bone.length, 0)).norm() : 1e9;
      local.y() -= std::clamp(local.y(), k == 1 ? 6.0 : 0.0, bone.length);
      const double along = 0.62 + 0.38 * smooth_step(11, 26, local.norm());
      const double at_joint = 0.54 + 0.46 * smooth_step(10, 24, joint);
      const double at_tip = 0.46 + 0.5 * smooth_step(6, 22, tip);
      length = std::min({length, along, at_joint, at_tip});
    }
  for (int d = 1; d + 1 < kDigits; ++d) {
    const Vector3d crotch =
        0.5 * (skeleton[bone_index(d, 1)].hand_from_bone * Vector3d(0, 18, 2) +
               skeleton[bone_index(d + 1, 1)].hand_from_bone * Vector3d(0, d == 3 ? 21 : 18, 2));
    length = std::min(length, 0.48 + 0.5 * smooth_step(5, 22, (p - crotch).norm()));
  }
  return length;
}

}  // namespace

TriangleMesh hand_shape(const HandSurface& surface) {
  const auto project = [&](const Vector3d& p) { return surface.project(p); };
  TriangleMesh fine = extract_surface(surface, {-80, -kStumpLength - 6, -40}, {100, 200, 80}, 2.5);
  for (Vector3d& v : fine.vertices) v = project(v);
  RemeshTarget target;
  target.vertices = kVertices;
  target.edge_length = [&](const Vector3d& p) { return 7.5 * edge_length(surface.skeleton(), p); };
  target.project = project;
  return remesh(fine, target);
}

}  // namespace hypotrack::hand_mesh
