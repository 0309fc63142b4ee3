#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "the_hand.hpp"

namespace hypotrack::hand_mesh {
namespace {

using Eigen::Vector3d;

Vector3d tip(const std::vector<Eigen::Isometry3d>& bones, int digit) {
  const int last = bone_index(digit, 3);
  return bones[last] * Vector3d(0, the_hand().skeleton[last].length, 0);
}

/// Extent along x of the vertices that `keep` accepts.
template <typename Keep>
double breadth(const std::vector<Vector3d>& vertices, const Keep& keep) {
  double low = 1e9, high = -1e9;
  for (const Vector3d& v : vertices)
    if (keep(v)) {
      low = std::min(low, v.x());
      high = std::max(high, v.x());
    }
  return high - low;
}

TEST(HandAnatomy, HasTwentyOneBonesInAHierarchyFromTheWrist) {
  const auto& bones = the_hand().skeleton;
  ASSERT_EQ(bones.size(), 21u);
  EXPECT_EQ(bones[0].name, "wrist");
  EXPECT_TRUE(bones[0].hand_from_bone.isApprox(Eigen::Isometry3d::Identity()));
  for (size_t b = 1; b < bones.size(); ++b) {
    EXPECT_GE(bones[b].parent, 0);
    EXPECT_LT(bones[b].parent, static_cast<int>(b));
  }
  EXPECT_EQ(bones[bone_index(1, 3)].name, "index_3");
  EXPECT_EQ(bones[bone_index(1, 3)].parent, bone_index(1, 2));
}

TEST(HandAnatomy, HasTheBoneLengthsOfTheTable) {
  for (int d = 1; d < kDigits; ++d) {
    const DigitMeasures& m = digit_measures()[d];
    const auto joint = [&](int k) {
      return the_hand().skeleton[bone_index(d, k)].hand_from_bone.translation();
    };
    EXPECT_NEAR((joint(1) - joint(0)).norm(), m.metacarpal, 0.01) << m.name;
    EXPECT_NEAR((joint(2) - joint(1)).norm(), m.proximal, 0.01) << m.name;
    EXPECT_NEAR((joint(3) - joint(2)).norm(), m.middle, 0.01) << m.name;
  }
}

TEST(HandAnatomy, IsAsLongAndBroadAsTheAverageHand) {
  const std::vector<Vector3d> flat = posed(flat_angles());
  double longest = 0;
  for (const Vector3d& v : flat) longest = std::max(longest, v.y());
  EXPECT_NEAR(longest, kHandLength, 0.02 * kHandLength);
  const auto across_the_knuckles = [](const Vector3d& v) {
    return v.y() > 74 && v.y() < 98 && v.x() < 45;  // without the thumb
  };
  EXPECT_NEAR(breadth(flat, across_the_knuckles), kHandBreadth, 0.04 * kHandBreadth);
  const auto around_the_wrist = [](const Vector3d& v) { return std::abs(v.y()) < 6; };
  EXPECT_NEAR(breadth(flat, around_the_wrist), kWristBreadth, 0.05 * kWristBreadth);
}

TEST(HandAnatomy, HasFingersAsBroadAsMeasured) {
  const HandAsset& hand = the_hand();
  for (int d = 0; d < kDigits; ++d) {
    const DigitMeasures& m = digit_measures()[d];
    for (int k = d == kThumb ? 3 : 2; k < kBonesPerDigit; ++k) {  // the first web spans its MCP
      const Eigen::Isometry3d bone_from_hand =
          hand.skeleton[bone_index(d, k)].hand_from_bone.inverse();
      std::vector<Vector3d> near;
      for (const Vector3d& v : hand.mesh.vertices) {
        const Vector3d local = bone_from_hand * v;
        if (std::abs(local.y()) < 4 && local.norm() < 16) near.push_back(local);
      }
      const double expected = k == 2 ? m.pip_breadth : m.dip_breadth;
      EXPECT_NEAR(breadth(near, [](const Vector3d&) { return true; }), expected, 0.09 * expected)
          << m.name << " joint " << k;
    }
  }
}

TEST(HandAnatomy, EndsShortlyBehindTheWrist) {
  double lowest = 0;
  for (const Vector3d& v : the_hand().mesh.vertices) lowest = std::min(lowest, v.y());
  EXPECT_LE(-lowest, 20);
  EXPECT_GE(-lowest, 5);
}

TEST(HandAnatomy, IsFlatAndStraightAtZeroAngles) {
  const auto bones = pose_skeleton(flat_angles());
  for (int d = 1; d < kDigits; ++d) {
    const Vector3d finger = tip(bones, d) - bones[bone_index(d, 1)].translation();
    EXPECT_NEAR(finger.normalized().y(), 1, 1e-9) << digit_measures()[d].name;
  }
}

TEST(HandAnatomy, FlexesTowardsThePalmAndAbductsTowardsTheThumb) {
  for (int d = 0; d < kDigits; ++d)
    for (int k = 0; k < 4; ++k) {
      DigitAngles bent = flat_angles();
      bent[d][k] = 0.3;
      const Vector3d moved = tip(pose_skeleton(bent), d) - tip(pose_skeleton(flat_angles()), d);
      const bool towards_the_palm = k > 0 || d == kThumb;
      EXPECT_GT(towards_the_palm ? moved.z() : moved.x(), 1)
          << digit_measures()[d].name << " angle " << k;
    }
}

TEST(HandAnatomy, KeepsTheFingersApartAtTheBindPose) {
  const HandAsset& hand = the_hand();
  const auto digit_of = [&](size_t v) {
    const int bone = hand.weights[v].bones[0];
    return bone > 0 && (bone - 1) % kBonesPerDigit >= 2 ? (bone - 1) / kBonesPerDigit : -1;
  };
  double least = 1e9;
  for (size_t a = 0; a < hand.mesh.vertices.size(); ++a)
    for (size_t b = 0; b < a; ++b)
      if (digit_of(a) >= 0 && digit_of(b) >= 0 && digit_of(a) != digit_of(b))
        least = std::min(least, (hand.mesh.vertices[a] - hand.mesh.vertices[b]).norm());
  EXPECT_GT(least, 3);
}

}  // namespace
}  // namespace hypotrack::hand_mesh
