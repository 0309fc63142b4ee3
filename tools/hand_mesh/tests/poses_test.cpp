#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "the_hand.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Mesh vertices around a joint, from the middle of the bend outwards.
std::vector<int> around_joint(int bone, double reach) {
  const HandAsset& hand = the_hand();
  const Isometry3d bone_from_hand = hand.skeleton[bone].hand_from_bone.inverse();
  std::vector<int> found;
  for (size_t v = 0; v < hand.mesh.vertices.size(); ++v) {
    const Vector3d local = bone_from_hand * hand.mesh.vertices[v];
    if (std::abs(local.y()) < reach && local.norm() < 16) found.push_back(static_cast<int>(v));
  }
  return found;
}

double breadth(const std::vector<int>& vertices, const std::vector<Vector3d>& positions,
               const Vector3d& axis) {
  double low = 1e9, high = -1e9;
  for (int v : vertices) {
    low = std::min(low, axis.dot(positions[v]));
    high = std::max(high, axis.dot(positions[v]));
  }
  return high - low;
}

TEST(HandSkinning, GivesEveryVertexWeightsThatSumToOne) {
  for (const VertexWeights& w : the_hand().weights) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      EXPECT_GE(w.weights[i], 0);
      EXPECT_GE(w.bones[i], 0);
      EXPECT_LT(w.bones[i], kBones);
      EXPECT_TRUE(w.weights[i] > 0 || w.bones[i] == 0);
      sum += w.weights[i];
    }
    ASSERT_NEAR(sum, 1, 1e-12);
  }
}

TEST(HandSkinning, GivesEveryBoneSkin) {
  std::array<double, kBones> held{};
  for (const VertexWeights& w : the_hand().weights)
    for (int i = 0; i < 4; ++i) held[w.bones[i]] += w.weights[i];
  for (int b = 0; b < kBones; ++b) EXPECT_GT(held[b], 1) << the_hand().skeleton[b].name;
}

TEST(HandSkinning, ChangesSmoothlyAlongEdges) {
  const HandAsset& hand = the_hand();
  const auto weight = [&](int v, int bone) {
    double sum = 0;
    for (int i = 0; i < 4; ++i)
      if (hand.weights[v].bones[i] == bone) sum += hand.weights[v].weights[i];
    return sum;
  };
  for (const Triangle& t : hand.mesh.triangles)
    for (int i = 0; i < 3; ++i)
      for (int b = 0; b < kBones; ++b) {
        if (b == 0 || (b - 1) % kBonesPerDigit == 0) continue;  // fixed ones move alike
        ASSERT_LT(std::abs(weight(t[i], b) - weight(t[(i + 1) % 3], b)), 0.75)
            << hand.skeleton[b].name << " at " << hand.mesh.vertices[t[i]].transpose();
      }
}

TEST(HandSkinning, MovesNoVertexThatItsNeighboursLeaveBehind) {
  const HandAsset& hand = the_hand();
  const auto moving = [&](int v) {
    double sum = 0;
    for (int i = 0; i < 4; ++i)
      if (hand.weights[v].bones[i] > 0 && (hand.weights[v].bones[i] - 1) % kBonesPerDigit > 0)
        sum += hand.weights[v].weights[i];
    return sum;
  };
  for (const Triangle& t : hand.mesh.triangles)
    for (int i = 0; i < 3; ++i)
      ASSERT_LT(std::abs(moving(t[i]) - moving(t[(i + 1) % 3])), 0.45)
          << hand.mesh.vertices[t[i]].transpose();
}

/// Triangles whose posed normal points against their vertices' blended bind normals.
int turned_over(const DigitAngles& angles) {
  const HandAsset& hand = the_hand();
  const std::vector<Vector3d> vertices = posed(angles);
  const std::vector<Isometry3d> bones = pose_skeleton(angles);
  int count = 0;
  for (const Triangle& t : hand.mesh.triangles) {
    Vector3d expected = Vector3d::Zero();
    for (int v : t)
      for (int i = 0; i < 4; ++i) {
        const int b = hand.weights[v].bones[i];
        expected += hand.weights[v].weights[i] *
                    (bones[b].linear() * hand.skeleton[b].hand_from_bone.linear().transpose() *
                     hand.attributes.normals[v]);
      }
    const Vector3d normal =
        (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
    count += normal.dot(expected) < 0;
  }
  return count;
}

TEST(HandSkinning, TurnsNoSkinInsideOut) {
  const DigitAngles spread = in_radians(
      {{{20, -15, -8, -10}, {18, -5, 0, 0}, {2, -5, 0, 0}, {-14, -5, 0, 0}, {-28, -5, 0, 0}}});
  EXPECT_EQ(turned_over(bind_angles()), 0);
  EXPECT_EQ(turned_over(flat_angles()), 0);
  EXPECT_EQ(turned_over(spread), 0);
  EXPECT_EQ(turned_over(pinch_angles()), 0);
  // In a fist skin folds away inside of the creases.
  EXPECT_LT(turned_over(fist_angles()), 0.03 * the_hand().mesh.triangles.size());
}

TEST(HandSkinning, LeavesTheNeighbouringFingersWhereTheyAre) {
  const HandAsset& hand = the_hand();
  for (int d = 0; d < kDigits; ++d) {
    DigitAngles angles = bind_angles();
    for (int k = 1; k < 4; ++k) angles[d][k] += 0.5;
    const std::vector<Vector3d> moved = posed(angles);
    for (int other = 0; other < kDigits; ++other) {
      if (other == d) continue;
      const SkeletonBone& bone = hand.skeleton[bone_index(other, 2)];
      const Isometry3d bone_from_hand = bone.hand_from_bone.inverse();
      for (size_t v = 0; v < moved.size(); ++v) {
        const Vector3d local = bone_from_hand * hand.mesh.vertices[v];
        if (local.y() < 0 || local.y() > bone.length || std::hypot(local.x(), local.z()) > 9)
          continue;
        ASSERT_LT((moved[v] - hand.mesh.vertices[v]).norm(), 1e-6)
            << digit_measures()[d].name << " moves " << bone.name;
      }
    }
  }
}

TEST(HandSkinning, DoesNotCollapseInAFist) {
  const HandAsset& hand = the_hand();
  const std::vector<Vector3d> fist = posed(fist_angles());
  const auto bones = pose_skeleton(fist_angles());
  for (int d = 1; d < kDigits; ++d)
    for (int k = 2; k < 4; ++k) {
      const int bone = bone_index(d, k);
      const std::vector<int> ring = around_joint(bone, 4);
      const double before =
          breadth(ring, hand.mesh.vertices, hand.skeleton[bone].hand_from_bone.linear().col(0));
      EXPECT_GT(breadth(ring, fist, bones[bone].linear().col(0)), 0.9 * before)
          << hand.skeleton[bone].name;
      // The knuckle: skin on the back of the joint stays away from its centre.
      double thickness_before = 0, thickness = 0;
      for (int v : ring) {
        const Vector3d local = hand.skeleton[bone].hand_from_bone.inverse() * hand.mesh.vertices[v];
        if (local.z() > -0.6 * digit_measures()[d].dip_breadth / 2) continue;
        thickness_before += std::hypot(local.y(), local.z());
        const Vector3d after = bones[bone].inverse() * fist[v];
        thickness += std::hypot(after.y(), after.z());
      }
      EXPECT_GT(thickness, 0.7 * thickness_before) << hand.skeleton[bone].name;
    }
}

TEST(HandSkinning, KeepsTheVolumeInAFistAndFlat) {
  const HandAsset& hand = the_hand();
  const double bind = volume(hand.mesh, hand.mesh.vertices);
  EXPECT_NEAR(volume(hand.mesh, posed(fist_angles())) / bind, 1, 0.08);
  EXPECT_NEAR(volume(hand.mesh, posed(flat_angles())) / bind, 1, 0.04);
}

TEST(HandSkinning, BringsThumbAndIndexTogetherInAPinch) {
  const auto bones = pose_skeleton(pinch_angles());
  const auto pulp = [&](int d) {
    const SkeletonBone& bone = the_hand().skeleton[bone_index(d, 3)];
    return bones[bone_index(d, 3)] *
           Vector3d(0, 0.75 * bone.length, 0.45 * digit_measures()[d].dip_breadth);
  };
  EXPECT_LT((pulp(kThumb) - pulp(1)).norm(), 12);
}

}  // namespace
}  // namespace hypotrack::hand_mesh
