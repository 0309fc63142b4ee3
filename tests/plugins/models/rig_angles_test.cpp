#include <gmock/gmock.h>

#include <map>

#include "hand_parameters.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/model.hpp"
#include "rigged_fixture.hpp"

namespace hypotrack::test {
namespace {

using Eigen::Vector3d;
using Degrees = std::map<std::string, double>;

ModelData rigged(const std::string& yaml) {
  return rig_hand(stick_hand(), parse_rig(yaml), "stick.yaml");
}

std::vector<double> state(const ModelData& data, const Degrees& degrees) {
  std::vector<double> values;
  for (const Parameter& parameter : data.parameters) {
    const auto given = degrees.find(parameter.name);
    values.push_back(given == degrees.end() ? parameter.rest : given->second * kDegree);
  }
  return values;
}

Vector3d landmark(const ModelData& data, const std::string& name, const Degrees& degrees) {
  const Eigen::Matrix3Xd all = posed_landmarks(Model(data), state(data, degrees));
  for (std::size_t i = 0; i < data.landmarks.size(); ++i) {
    if (data.landmarks[i].name == name) return all.col(static_cast<Eigen::Index>(i));
  }
  ADD_FAILURE() << name;
  return Vector3d::Zero();
}

double bind_deg(const ModelData& data, const std::string& name) {
  for (const BoneMotion& rotation : data.motions) {
    if (data.parameters[static_cast<std::size_t>(rotation.parameter)].name == name) {
      return rotation.zero / kDegree;
    }
  }
  ADD_FAILURE() << name;
  return 0;
}

TEST(RigAngles, BindPoseIsMeasured) {
  const ModelData data = rigged(stick_rig());
  EXPECT_NEAR(bind_deg(data, "index_abduction"), 12, 1e-6);
  EXPECT_NEAR(bind_deg(data, "index_flexion_1"), 20, 1e-6);
  EXPECT_NEAR(bind_deg(data, "index_flexion_2"), 30, 1e-6);
  EXPECT_NEAR(bind_deg(data, "index_flexion_3"), 10, 1e-6);
  EXPECT_NEAR(bind_deg(data, "thumb_abduction"), 0, 1e-6);
  EXPECT_NEAR(bind_deg(data, "ring_flexion_2"), 0, 1e-6);
}

TEST(RigAngles, ZeroIsTheStraightHandWhateverTheBindPose) {
  const ModelData data = rigged(stick_rig());
  EXPECT_TRUE(landmark(data, "index_tip", {}).isApprox(Vector3d(0.03, 0.18, 0), 1e-7));
  const Vector3d thumb = landmark(data, "thumb_tip", {}) - landmark(data, "thumb_cmc", {});
  EXPECT_TRUE(thumb.isApprox(0.09 * Vector3d(1, 1, 0).normalized(), 1e-7));
}

TEST(RigAngles, MeasuredBindAnglesGiveTheBindPoseBack) {
  const ModelData data = rigged(stick_rig());
  const auto values = state(data, {{"index_abduction", 12},
                                   {"index_flexion_1", 20},
                                   {"index_flexion_2", 30},
                                   {"index_flexion_3", 10}});
  EXPECT_TRUE(posed_vertices(Model(data), values).isApprox(data.mesh.vertices, 1e-5f));
}

TEST(RigAngles, FlexionTurnsDistalToPalmarAndAbductionTowardsTheThumb) {
  const ModelData data = rigged(stick_rig());
  const Vector3d mcp = landmark(data, "index_mcp", {});
  EXPECT_TRUE(landmark(data, "index_tip", {{"index_flexion_1", 90}})
                  .isApprox(mcp + Vector3d(0, 0, 0.09), 1e-7));
  EXPECT_TRUE(landmark(data, "index_tip", {{"index_flexion_2", 90}})
                  .isApprox(mcp + Vector3d(0, 0.03, 0.06), 1e-7));
  EXPECT_TRUE(landmark(data, "index_tip", {{"index_abduction", 90}})
                  .isApprox(mcp + Vector3d(0.09, 0, 0), 1e-7));
  EXPECT_TRUE(landmark(data, "index_tip", {{"index_abduction", 90}, {"index_flexion_1", 30}})
                  .isApprox(mcp + 0.09 * Vector3d(std::cos(30 * kDegree), 0, 0.5), 1e-7))
      << "abduction comes first, flexion in the abducted finger";
}

TEST(RigAngles, BendFindsTheFlexionAxisOfABentFinger) {
  const std::string first =
      replaced(stick_rig(), "end: index_2", "end: index_2, flexion_axis: bend");
  const ModelData data =
      rigged(replaced(first, "end: index_3", "end: index_3, flexion_axis: bend"));
  EXPECT_NEAR(bind_deg(data, "index_flexion_1"), 20, 1e-4);
  EXPECT_NEAR(bind_deg(data, "index_flexion_2"), 30, 1e-4);
}

TEST(RigAngles, HandAxisMeasuresDirectionsWithoutTwist) {
  const ModelData data = rigged(replaced(stick_rig(), "flexion_axis: x", "flexion_axis: hand"));
  EXPECT_NEAR(bind_deg(data, "index_abduction"), 12, 1e-4);
  EXPECT_NEAR(bind_deg(data, "index_flexion_1"), 20, 1e-4);
}

TEST(RigAngles, BindDegReplacesTheMeasurement) {
  const ModelData data =
      rigged(stick_rig() + "parameters: [{name: index_flexion_2, bind_deg: 25}]\n");
  EXPECT_NEAR(bind_deg(data, "index_flexion_2"), 25, 1e-9);
}

TEST(RigAngles, ABoneThatNoParameterDrivesDoesNotChangeWhatZeroMeans) {
  // A metacarpal below the middle finger that points elsewhere.
  std::string yaml = replaced(stick_rig(), "  - {name: middle_1, parent: wrist",
                              "  - {name: middle_0, parent: wrist, joint_at: [0, 0.02, 0], "
                              "end: index_1, flexion_axis: hand, weights: [middle_tip]}\n"
                              "  - {name: middle_1, parent: middle_0");
  yaml = replaced(yaml, "weights: [middle_3, middle_tip]", "weights: [middle_3]");
  const ModelData data = rigged(yaml);
  EXPECT_TRUE((landmark(data, "middle_tip", {}) - landmark(data, "middle_mcp", {}))
                  .isApprox(Vector3d(0, 0.09, 0), 1e-7));
}

TEST(RigAngles, LeftFileIsTheMirrorImageOfTheSameHandAsRightFile) {
  // The same file mirrored in x: geometry and bone frames, as a modelling program does it. Its
  // bones then flex about +x just the same (a mirror keeps rotations about its normal's axis).
  ImportedMesh left = stick_hand();
  const Vector3d flip(-1, 1, 1);
  left.mesh.vertices.row(0) *= -1;
  left.mesh.triangles.row(1).swap(left.mesh.triangles.row(2));
  for (ImportedBone& bone : left.bones) {
    bone.file_from_bone.linear() =
        flip.asDiagonal() * bone.file_from_bone.linear() * flip.asDiagonal();
    bone.file_from_bone.translation() = flip.asDiagonal() * bone.file_from_bone.translation();
  }
  const std::string yaml = "side: left\n" + replaced(stick_rig(), "x: x, y: y", "x: -x, y: y");
  const ModelData data = rig_hand(left, parse_rig(yaml), "left.yaml");
  const ModelData right = rigged(stick_rig());
  const Degrees pose = {{"index_abduction", 20},
                        {"index_flexion_1", 50},
                        {"thumb_flexion_2", 30},
                        {"thumb_abduction", 15}};
  const Eigen::Matrix3Xd expected =
      flip.asDiagonal() * posed_landmarks(Model(right), state(right, pose));
  EXPECT_TRUE(posed_landmarks(Model(data), state(data, pose)).isApprox(expected, 1e-7));
  EXPECT_TRUE(data.mesh.vertices.isApprox(left.mesh.vertices, 1e-6f));
}

TEST(RigAngles, ParametersAndLandmarksHaveTheirNamesInOrder) {
  const ModelData data = rigged(stick_rig());
  ASSERT_EQ(data.parameters.size(), 27u);
  ASSERT_EQ(data.landmarks.size(), 21u);
  EXPECT_EQ(data.parameters[7].name, "thumb_abduction");
  EXPECT_EQ(data.parameters[11].name, "index_abduction");
  EXPECT_EQ(data.parameters[26].name, "little_flexion_3");
  for (std::size_t i = 0; i < 21; ++i) EXPECT_EQ(data.landmarks[i].name, hand_landmarks()[i]);
}

TEST(RigAngles, BoundsRestAndLandmarksCanBeReplaced) {
  const ModelData data =
      rigged(stick_rig() +
             "parameters: [{name: ring_flexion_1, bounds_deg: [-5, 70], rest_deg: 10}]\n"
             "landmarks: [{name: ring_tip, bone: ring_3, position_mm: [1, 25, 4]}]\n");
  const Parameter& ring = data.parameters[20];
  EXPECT_EQ(ring.name, "ring_flexion_1");
  EXPECT_NEAR(ring.lower, -5 * kDegree, 1e-12);
  EXPECT_NEAR(ring.upper, 70 * kDegree, 1e-12);
  EXPECT_NEAR(ring.rest, 10 * kDegree, 1e-12);
  const Vector3d tip = landmark(data, "ring_tip", {{"ring_flexion_1", 0}});
  EXPECT_TRUE(tip.isApprox(Vector3d(-0.01 + 0.001, 0.09 + 0.06 + 0.025, 0.004), 1e-7));
}

}  // namespace
}  // namespace hypotrack::test
