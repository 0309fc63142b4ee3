#include "hypotrack/plugin/kinematics.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/shape.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Isometry3d along_y(double distance) {
  return Eigen::Isometry3d(Eigen::Translation3d(0, distance, 0));
}

// Two bones of 1 m and 2 m along y, one angle about x each, and a point 3 m beyond the second
// joint.
ModelData two_link_arm() {
  ModelData data;
  data.bones = {{"upper", -1, along_y(1)}, {"lower", 0, along_y(2)}};
  data.parameters = pose_parameters();
  data.parameters.push_back({"shoulder", ParameterKind::angle, -4, 4, 0});
  data.parameters.push_back({"elbow", ParameterKind::angle, -4, 4, 0});
  data.motions = {{0, 7, Eigen::Vector3d::UnitX(), 0, 1}, {1, 8, Eigen::Vector3d::UnitX(), 0, 1}};
  data.landmarks = {{"elbow", 1, Eigen::Vector3d::Zero()}, {"hand", 1, {0, 3, 0}}};
  data.mesh.vertices.resize(3, 3);
  data.mesh.vertices << 0, 0, 1, 2, 6, 6, 0, 0, 0;  // columns: (0 2 0), (0 6 0), (1 6 0)
  data.mesh.triangles = Eigen::Vector3i(0, 1, 2);
  data.mesh.bone_indices = Eigen::Matrix4Xi::Zero(4, 3);
  data.mesh.bone_indices.row(1).setOnes();
  data.mesh.bone_weights = Eigen::Matrix4Xf::Zero(4, 3);
  data.mesh.bone_weights.row(0) << 1, 0, 0.5;
  data.mesh.bone_weights.row(1) << 0, 1, 0.5;
  return data;
}

std::vector<double> pose(std::initializer_list<double> angles) {
  std::vector<double> parameters = {0, 0, 0, 1, 0, 0, 0};
  parameters.insert(parameters.end(), angles);
  return parameters;
}

void expect_near(const Eigen::Vector3d& actual, const Eigen::Vector3d& expected) {
  EXPECT_LT((actual - expected).norm(), 1e-12)
      << "actual " << actual.transpose() << ", expected " << expected.transpose();
}

TEST(WorldFromModel, RotatesThenMoves) {
  const double half = std::sqrt(0.5);  // 90 degrees about z
  const std::vector<double> parameters = {1, 2, 3, half, 0, 0, half};
  expect_near(world_from_model(parameters) * Eigen::Vector3d(1, 0, 0), {1, 3, 3});
}

TEST(WorldFromModel, DoesNotCareAboutTheLengthOfTheQuaternion) {
  for (const double scale : {1e-200, 0.1, 7.0, -1.0, 1e200}) {
    const std::vector<double> unit = {0, 0, 0, 0.5, 0.5, -0.5, 0.5};
    std::vector<double> scaled = unit;
    for (std::size_t i = 3; i < 7; ++i) scaled[i] *= scale;
    EXPECT_TRUE(world_from_model(scaled).isApprox(world_from_model(unit), 1e-12)) << scale;
  }
}

TEST(WorldFromModel, TakesTheZeroQuaternionForTheIdentity) {
  const std::vector<double> parameters = {1, 2, 3, 0, 0, 0, 0};
  const Eigen::Isometry3d expected(Eigen::Translation3d(1, 2, 3));
  EXPECT_TRUE(world_from_model(parameters).isApprox(expected, 0));
}

TEST(WorldFromModel, RefusesTooFewParameters) {
  const std::vector<double> parameters(6, 0.0);
  try {
    world_from_model(parameters);
    FAIL();
  } catch (const DataError& error) {
    EXPECT_STREQ(error.what(), "pose of a model: found 6 parameters, expected 7");
  }
}

TEST(ForwardKinematics, StandsAtTheBindPoseWhereEveryAngleIsZero) {
  const ModelData data = two_link_arm();
  const auto bind = bind_transforms(data);
  const auto posed = world_from_bones(data, pose({0, 0}));
  ASSERT_EQ(bind.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(posed[i].isApprox(bind[i], 1e-15));
  expect_near(bind[1].translation(), {0, 3, 0});
}

TEST(ForwardKinematics, ChainsTheRotationsOfParentsAndChildren) {
  const Model arm(two_link_arm());
  // The shoulder turns +y to +z: the elbow is 2 m in front of the shoulder at y = 1. The elbow
  // turns +z on to -y: the hand is 3 m below the elbow.
  const Eigen::Matrix3Xd landmarks = posed_landmarks(arm, pose({kPi / 2, kPi / 2}));
  expect_near(landmarks.col(0), {0, 1, 2});
  expect_near(landmarks.col(1), {0, -2, 2});
}

TEST(ForwardKinematics, AppliesZeroAndScaleOfARotation) {
  ModelData data = two_link_arm();
  data.motions[0].zero = 0.25;
  data.motions[0].scale = -2;
  const Model arm(data);
  // -2 * (0.25 + pi/4 - 0.25) = -pi/2: +y goes to -z.
  const Eigen::Matrix3Xd landmarks = posed_landmarks(arm, pose({0.25 + kPi / 4, 0}));
  expect_near(landmarks.col(0), {0, 1, -2});
}

TEST(ForwardKinematics, TurnsLaterRotationsOfABoneInTheFrameOfTheEarlier) {
  ModelData data = two_link_arm();
  data.motions[1] = {0, 8, Eigen::Vector3d::UnitZ(), 0, 1};  // the same bone, x then z
  const Model arm(data);
  // R_x(90) R_z(90) y = R_x(90) (-x) = -x. The other order would give R_z(90) z = z.
  const Eigen::Matrix3Xd landmarks = posed_landmarks(arm, pose({kPi / 2, kPi / 2}));
  expect_near(landmarks.col(0), {-2, 1, 0});
}

TEST(ForwardKinematics, SlidesABoneAlongAnAxisOfItsOwnFrame) {
  ModelData data = two_link_arm();
  data.parameters[8] = {"reach", ParameterKind::length, -1, 1, 0};
  data.motions[1] = {1, 8, Eigen::Vector3d::UnitY(), 0.25, 2, MotionKind::translation};
  const Model arm(data);
  // The shoulder turns +y to +z; the lower bone begins 2 * (0.5 - 0.25) m farther along that.
  const Eigen::Matrix3Xd landmarks = posed_landmarks(arm, pose({kPi / 2, 0.5}));
  expect_near(landmarks.col(0), {0, 1, 2.5});
  expect_near(landmarks.col(1), {0, 1, 5.5});
}

TEST(ForwardKinematics, AParameterMovesSeveralBonesByMultiplesAndOffsets) {
  ModelData data = two_link_arm();
  data.parameters.pop_back();
  data.motions[1] = {1, 7, Eigen::Vector3d::UnitX(), kPi / 4, -1};  // pi / 4 minus the shoulder
  const Model arm(data);
  const Eigen::Matrix3Xd landmarks = posed_landmarks(arm, pose({kPi / 2}));
  // The shoulder turns +y to +z, the elbow by -pi / 4 back between them.
  expect_near(landmarks.col(0), {0, 1, 2});
  expect_near(landmarks.col(1), {0, 1 + 3 * std::sqrt(0.5), 2 + 3 * std::sqrt(0.5)});
}

TEST(ScaledModel, SlidesFartherWithTheSameParameters) {
  const ModelData cabinet = test::make_test_cabinet();
  ModelData large = cabinet;
  scale_model(large, 3);
  ModelData stretched = cabinet;
  stretch_bones(stretched, std::vector(cabinet.bones.size(), BoneStretch{{3, 3, 3}, false}));
  const std::vector<double> parameters = {0, 0, 0, 1, 0, 0, 0, 0.05, 0.7, 2};
  const Eigen::Matrix3Xd expected = 3 * posed_landmarks(Model(cabinet), parameters);
  EXPECT_TRUE(posed_landmarks(Model(large), parameters).isApprox(expected, 1e-12));
  EXPECT_TRUE(posed_landmarks(Model(stretched), parameters).isApprox(expected, 1e-12));
}

TEST(Skinning, KeepsTheBindPoseWhereEveryAngleIsZero) {
  const Model arm(two_link_arm());
  const Eigen::Matrix3Xf vertices = posed_vertices(arm, pose({0, 0}));
  EXPECT_TRUE(vertices.isApprox(arm.data().mesh.vertices, 1e-6f));
}

TEST(Skinning, BlendsWhereTwoBonesHoldAVertex) {
  const Model arm(two_link_arm());
  const Eigen::Matrix3Xf vertices = posed_vertices(arm, pose({0, kPi / 2}));
  // The lower bone turns about (0, 3, 0): (0 6 0) goes to (0 3 3), and (1 6 0) half way to (1 3 3).
  EXPECT_LT((vertices.col(0) - Eigen::Vector3f(0, 2, 0)).norm(), 1e-6f);
  EXPECT_LT((vertices.col(1) - Eigen::Vector3f(0, 3, 3)).norm(), 1e-6f);
  EXPECT_LT((vertices.col(2) - Eigen::Vector3f(1, 4.5, 1.5)).norm(), 1e-6f);
}

TEST(Skinning, MovesEverythingWithTheRoot) {
  const Model hand(test::make_test_hand());
  std::vector<double> parameters(27, 0.1);
  for (std::size_t i = 0; i < 7; ++i) parameters[i] = i == 3 ? 1 : 0;
  const Eigen::Matrix3Xf at_origin = posed_vertices(hand, parameters);
  parameters[0] = 0.3;
  parameters[2] = 0.6;
  parameters[4] = -0.7;
  const Eigen::Isometry3f root = world_from_model(parameters).cast<float>();
  EXPECT_LT(((root * at_origin) - posed_vertices(hand, parameters)).cwiseAbs().maxCoeff(), 1e-6f);
}

// A model that a skeleton cannot express: it inflates about its position.
class Balloon : public Model {
 public:
  Balloon() : Model(test::make_test_box()) {}

 protected:
  bool do_poses_itself() const override { return true; }
  void do_pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
               Eigen::Matrix3Xd& landmarks) const override {
    vertices = 2 * data().mesh.vertices;
    landmarks = Eigen::Matrix3Xd::Constant(3, 3, parameters[0]);
  }
};

TEST(PosesItself, IsAskedForVerticesAndLandmarks) {
  const Balloon balloon;
  const std::vector<double> parameters = {5, 0, 0, 1, 0, 0, 0};
  EXPECT_EQ(posed_vertices(balloon, parameters), 2 * balloon.data().mesh.vertices);
  EXPECT_EQ(posed_landmarks(balloon, parameters), Eigen::Matrix3Xd::Constant(3, 3, 5));
}

TEST(PosesItself, OtherNumbersOfVerticesOrLandmarksThanItsDataAreRefused) {
  class Wrong final : public Balloon {
   public:
    Wrong(int vertices, int landmarks) : vertices_(vertices), landmarks_(landmarks) {}

   private:
    void do_pose(std::span<const double>, Eigen::Matrix3Xf& vertices,
                 Eigen::Matrix3Xd& landmarks) const override {
      vertices.setZero(3, vertices_);
      landmarks.setZero(3, landmarks_);
    }

    int vertices_, landmarks_;
  };
  const auto count = static_cast<int>(Balloon().data().mesh.vertices.cols());
  const std::vector<double> parameters = {5, 0, 0, 1, 0, 0, 0};
  EXPECT_NO_THROW(posed_vertices(Wrong(count, 3), parameters));
  EXPECT_THROW(posed_vertices(Wrong(2, 3), parameters), PluginError);
  EXPECT_THROW(posed_landmarks(Wrong(count, 0), parameters), PluginError);
}

TEST(PosesItself, DefaultPoseIsTheSkinningOfTheData) {
  const Model hand(test::make_test_hand());
  const std::vector<double> parameters(27, 0.2);
  Eigen::Matrix3Xf vertices;
  Eigen::Matrix3Xd landmarks;
  hand.pose(parameters, vertices, landmarks);
  EXPECT_EQ(vertices, posed_vertices(hand, parameters));
  EXPECT_EQ(landmarks, posed_landmarks(hand, parameters));
}

}  // namespace
}  // namespace hypotrack
