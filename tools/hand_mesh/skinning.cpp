#include "skinning.hpp"

#include <algorithm>
#include <cmath>

#include "field.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A weight for every bone; the wrist's stands for all bones that are fixed to it until the end.
using Row = Eigen::Array<double, kBones, 1>;

/// Less would move the skin by a fraction of a millimetre, of a neighbouring finger perhaps.
constexpr double kNegligible = 0.01;

double distance_to_bone(const SkeletonBone& bone, const Vector3d& p, double from = 0) {
  Vector3d local = bone.hand_from_bone.inverse() * p;
  local.y() -= std::clamp(local.y(), from, bone.length);
  return local.norm();
}

bool is_fixed(int bone) { return bone == 0 || (bone - 1) % kBonesPerDigit == 0; }

/// The finger that is nearest, relative to its thickness.
int nearest_finger(const std::vector<SkeletonBone>& skeleton, const Vector3d& p) {
  int nearest = 1;
  double least = 1e9;
  for (int d = 1; d < kDigits; ++d)
    for (int k = 1; k < kBonesPerDigit; ++k) {
      const double distance =
          distance_to_bone(skeleton[bone_index(d, k)], p) - 0.5 * digit_measures()[d].pip_breadth;
      if (distance < least) {
        least = distance;
        nearest = d;
      }
    }
  return nearest;
}

/// 0 proximal of a joint, 1 distal of it. The plane of the joint is `shift` distal of its centre
/// and leans distally towards the palm by `lean`: there the skin stays behind when the joint bends.
double beyond_joint(const SkeletonBone& distal_bone, const Vector3d& p, double shift, double lean,
                    double half_width) {
  const Vector3d local = distal_bone.hand_from_bone.inverse() * p;
  const double along = local.y() - shift - lean * local.z();
  return smooth_step(-half_width, half_width, along);
}

void add_phalanges(const std::vector<SkeletonBone>& skeleton, int digit, const Vector3d& p,
                   double share, double middle_width, double distal_width, Row& row) {
  const int first = bone_index(digit, 1);
  const double second = beyond_joint(skeleton[first + 1], p, 0, 0, middle_width);
  const double third = second * beyond_joint(skeleton[first + 2], p, 0, 0, distal_width);
  row[first] += share * (1 - second);
  row[first + 1] += share * (second - third);
  row[first + 2] += share * third;
}

/// How far the thumb takes the skin with it: its free part fully, its metacarpal fully around the
/// head, fading towards the wrist, the palm and the first web.
double thumb_share(const std::vector<SkeletonBone>& skeleton, const Vector3d& p) {
  const SkeletonBone& metacarpal = skeleton[bone_index(kThumb, 1)];
  const SkeletonBone& proximal = skeleton[bone_index(kThumb, 2)];
  const double along = (metacarpal.hand_from_bone.inverse() * p).y();
  const double at_metacarpal =
      smooth_step(-10, 32, along) * (1 - smooth_step(11, 38, distance_to_bone(metacarpal, p, 12)));
  const double away =
      std::min(distance_to_bone(proximal, p), distance_to_bone(skeleton[bone_index(kThumb, 3)], p));
  const double free = beyond_joint(proximal, p, 0, 0.15, 8.0) * (1 - smooth_step(12, 21, away));
  return std::max(at_metacarpal, free);
}

Row raw_weights(const std::vector<SkeletonBone>& skeleton, const Vector3d& p) {
  Row row = Row::Zero();
  const int finger = nearest_finger(skeleton, p);
  const double of_finger = beyond_joint(skeleton[bone_index(finger, 1)], p, 3.5, 0.32, 11.0);
  const double of_thumb = thumb_share(skeleton, p);
  // A finger's side of the first web is the finger's.
  const double near_finger =
      1 - smooth_step(10, 22,
                      distance_to_bone(skeleton[bone_index(finger, 1)], p) -
                          distance_to_bone(skeleton[bone_index(kThumb, 2)], p) + 10);
  const double thumb = of_thumb * (1 - of_finger * near_finger);
  add_phalanges(skeleton, kThumb, p, thumb, 6.0, 4.5, row);
  add_phalanges(skeleton, finger, p, of_finger * (1 - thumb), 4.5, 4.0, row);
  row[0] = 1 - row.tail<kBones - 1>().sum();
  return row;
}

/// Means over neighbours on the surface: weights spread around a finger's root but never across the
/// gap between two fingers.
void diffuse(const TriangleMesh& mesh, int rounds, std::vector<Row>& rows) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<Row> sums(rows.size(), Row::Zero());
    std::vector<int> counts(rows.size(), 0);
    for (const Triangle& t : mesh.triangles)
      for (int i = 0; i < 3; ++i) {
        sums[t[i]] += rows[t[(i + 1) % 3]];
        ++counts[t[i]];
      }
    for (size_t v = 0; v < rows.size(); ++v) rows[v] = 0.5 * rows[v] + 0.5 * sums[v] / counts[v];
  }
}

/// Shares the wrist's weight out among the wrist and the fixed bones near by.
void share_among_fixed(const std::vector<SkeletonBone>& skeleton, const Vector3d& p, Row& row) {
  const double total = row[0];
  Row share = Row::Zero();
  for (int d = 0; d < kDigits; ++d) {
    const int bone = bone_index(d, 0);
    share[bone] = std::pow(distance_to_bone(skeleton[bone], p) + 2.0, -4.0);
  }
  share *= smooth_step(10, 45, p.y()) / share.sum();
  share[0] = 1 - share.sum();
  row[0] = 0;
  row += total * share;
}

/// Bones of one kind by falling weight, without the negligible.
std::vector<int> ranked(const Row& row, bool fixed) {
  std::vector<int> bones;
  for (int b = 0; b < kBones; ++b)
    if (is_fixed(b) == fixed && row[b] >= kNegligible) bones.push_back(b);
  std::stable_sort(bones.begin(), bones.end(), [&](int a, int b) { return row[a] > row[b]; });
  return bones;
}

/// The four that matter. Moving bones come first, but the fixed ones together, which move alike,
/// keep their full weight on at least one slot where it is more than the fourth moving bone's.
VertexWeights strongest(const Row& row) {
  std::vector<int> moving = ranked(row, false), fixed = ranked(row, true);
  double fixed_total = 0, fixed_kept = 0;
  for (int b : fixed) fixed_total += row[b];
  if (moving.size() > 3) moving.resize(fixed_total > row[moving[3]] ? 3 : 4);
  fixed.resize(std::min(fixed.size(), 4 - moving.size()));
  for (int b : fixed) fixed_kept += row[b];
  VertexWeights result;
  int slot = 0;
  double sum = 0;
  for (const std::vector<int>* bones : {&moving, &fixed})
    for (int b : *bones) {
      result.bones[slot] = b;
      result.weights[slot] = is_fixed(b) ? row[b] * fixed_total / fixed_kept : row[b];
      sum += result.weights[slot++];
    }
  for (double& w : result.weights) w /= sum;
  return result;
}

}  // namespace

std::vector<VertexWeights> skin_weights(const TriangleMesh& mesh,
                                        const std::vector<SkeletonBone>& skeleton) {
  std::vector<Row> rows;
  for (const Vector3d& p : mesh.vertices) rows.push_back(raw_weights(skeleton, p));
  diffuse(mesh, 4, rows);
  std::vector<VertexWeights> weights;
  for (size_t v = 0; v < rows.size(); ++v) {
    share_among_fixed(skeleton, mesh.vertices[v], rows[v]);
    weights.push_back(strongest(rows[v]));
  }
  return weights;
}

std::vector<Vector3d> skin(const TriangleMesh& mesh, const std::vector<VertexWeights>& weights,
                           const std::vector<SkeletonBone>& skeleton,
                           const std::vector<Isometry3d>& hand_from_bone) {
  std::vector<Isometry3d> moved;
  for (size_t b = 0; b < skeleton.size(); ++b)
    moved.push_back(hand_from_bone[b] * skeleton[b].hand_from_bone.inverse());
  std::vector<Vector3d> vertices;
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    Vector3d p = Vector3d::Zero();
    for (int i = 0; i < 4; ++i)
      p += weights[v].weights[i] * (moved[weights[v].bones[i]] * mesh.vertices[v]);
    vertices.push_back(p);
  }
  return vertices;
}

}  // namespace hypotrack::hand_mesh
