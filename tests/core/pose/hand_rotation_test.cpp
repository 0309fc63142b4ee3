#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "expect_error.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/pose.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using testing::AllOf;
using testing::HasSubstr;

/// The scene of one hand that ships with hypotrack.
class HandRotation : public testing::Test {
 protected:
  static Scene scene_of(const std::string& model) {
    return Scene({{"hand", std::shared_ptr<const Model>(
                               PluginLoader().make<Model>(ConfigNode::parse(model, "test")))}});
  }
  static Eigen::VectorXd read(const Scene& scene, const std::string& rotation,
                              std::span<const Camera> cameras = {}) {
    return read_pose(ConfigNode::parse("{hand: {" + rotation + "}}", "pose.yaml"), scene,
                     scene.rest_state(), cameras);
  }
  /// Returns a landmark's position.
  static Eigen::Vector3d at(const Scene& scene, const Eigen::VectorXd& state,
                            const std::string& name) {
    const auto& names = scene.landmark_names();
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == "hand." + name)
        return scene.landmarks(state).col(static_cast<Eigen::Index>(i));
    throw std::out_of_range(name);
  }
  static std::string refusal(const Scene& scene, const std::string& rotation) {
    return message_of<ConfigError>([&] { read(scene, rotation); });
  }

  const Scene hand_ = scene_of("{type: hand}");
};

TEST_F(HandRotation, OfAPalmToTheCameraIsTheHalfTurnAboutX) {
  const Eigen::VectorXd words = read(hand_, "rotation: {palm: to_camera, fingers: up}");
  const Eigen::VectorXd degrees = read(hand_, "rotation_deg: [180, 0, 0]");
  EXPECT_NEAR(words.segment<4>(3).norm(), 1, 1e-12);
  EXPECT_GT(std::abs(words.segment<4>(3).dot(degrees.segment<4>(3))), std::cos(5 * kDegree));
}

TEST_F(HandRotation, PointsAnyHandAsItSays) {
  struct Case {
    std::string rotation;
    Eigen::Vector3d palm, fingers;
  };
  for (const char* model : {"{type: hand}", "{type: mirrored_hand, of: {type: hand}}"}) {
    const Scene scene = scene_of(model);
    for (const Case& c :
         {Case{"{palm: away, fingers: left}", {0, 0, 1}, {-1, 0, 0}},
          Case{"{palm: down, fingers: away}", {0, 1, 0}, {0, 0, 1}},
          Case{"{palm: right, fingers: up}", {1, 0, 0}, {0, -1, 0}},
          Case{"{palm: [0, 0, -2], fingers: [3, 3, 0]}", {0, 0, -1}, {0.7071, 0.7071, 0}}}) {
      const Eigen::VectorXd state = read(scene, "rotation: " + c.rotation);
      const Eigen::Vector3d wrist = at(scene, state, "wrist");
      const Eigen::Vector3d fingers =
          at(scene, state, "index_mcp") + at(scene, state, "little_mcp");
      EXPECT_GT((fingers / 2 - wrist).normalized().dot(c.fingers), 0.99) << model << c.rotation;
      Eigen::VectorXd bent = state;
      const auto& parameters = scene.parameters();
      for (std::size_t i = kPoseSize; i < parameters.size(); ++i)
        if (parameters[i].name.find("flexion_1") != std::string::npos)
          bent[static_cast<Eigen::Index>(i)] = 60 * kDegree;
      const Eigen::Vector3d moved = at(scene, bent, "middle_tip") - at(scene, state, "middle_tip");
      EXPECT_GT(moved.dot(c.palm), 0.03) << model << c.rotation << ": fingers bend to the palm";
    }
  }
}

TEST_F(HandRotation, IsAsTheFirstCameraSeesIt) {
  Camera camera;
  camera.camera_from_world.linear() =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::VectorXd state =
      read(hand_, "rotation: {palm: to_camera, fingers: up}", std::span(&camera, 1));
  const Eigen::Vector3d fingers = at(hand_, state, "index_mcp") + at(hand_, state, "little_mcp") -
                                  2 * at(hand_, state, "wrist");
  EXPECT_GT(
      (camera.camera_from_world.linear() * fingers).normalized().dot(-Eigen::Vector3d::UnitY()),
      0.99);
}

TEST_F(HandRotation, TurnsBothDirectionsAlikeUntilTheyArePerpendicular) {
  const Eigen::VectorXd state = read(hand_, "rotation: {palm: [0, 0, -1], fingers: [0, -1, 0.36]}");
  const Eigen::Vector3d fingers =
      (at(hand_, state, "index_mcp") + at(hand_, state, "little_mcp")) / 2 -
      at(hand_, state, "wrist");
  const double tilt = std::atan2(fingers.z(), -fingers.y());
  EXPECT_NEAR(tilt, std::atan(0.36) / 2, 3 * kDegree);
}

TEST_F(HandRotation, IsRefusedIfItIsNone) {
  EXPECT_THAT(refusal(hand_, "rotation: {palm: up, fingers: up}"),
              AllOf(HasSubstr("pose.yaml:1:"), HasSubstr("0 degrees apart"),
                    HasSubstr("60 to 120 degrees")));
  EXPECT_THAT(refusal(hand_, "rotation: {palm: [0, 0, 1], fingers: [0, 1, 0.8]}"),
              HasSubstr("51 degrees apart"));
  EXPECT_THAT(refusal(hand_, "rotation: {palm: camera, fingers: up}"),
              AllOf(HasSubstr("'camera'"), HasSubstr("to_camera, away, left, right, up, down")));
  EXPECT_THAT(refusal(hand_, "rotation: {palm: [0, 1], fingers: up}"), HasSubstr("has 2 numbers"));
  EXPECT_THAT(refusal(hand_, "rotation: {palm: [0, 0, 0], fingers: up}"), HasSubstr("are 0"));
  EXPECT_THAT(refusal(hand_, "rotation: {palm: up}"), HasSubstr("fingers"));
  EXPECT_THAT(refusal(hand_, "rotation_deg: [0, 0, 0], rotation: {palm: away, fingers: up}"),
              HasSubstr("both rotation_deg and rotation are given"));
  const Scene box({{"hand", std::make_shared<Model>(test::make_test_box())}});
  EXPECT_THAT(refusal(box, "rotation: {palm: away, fingers: up}"),
              AllOf(HasSubstr("is no hand"), HasSubstr("rotation_deg")));
}

TEST_F(HandRotation, SurvivesWritingAndReadingAPose) {
  Eigen::VectorXd state = read(hand_,
                               "position_mm: [10, -20, 500], rotation: {palm: away, fingers: up}, "
                               "angles_deg: {index_flexion_1: 33.3}");
  const std::string text = pose_yaml(hand_, state, {true});
  const Eigen::VectorXd again =
      read_pose(ConfigNode::parse(text, "written"), hand_, hand_.rest_state());
  EXPECT_LT((again - state).cwiseAbs().maxCoeff(), 1e-6) << text;
  for (std::size_t i = kPoseSize; i < hand_.parameters().size(); ++i)
    state[static_cast<Eigen::Index>(i)] = hand_.parameters()[i].upper;
  const Eigen::VectorXd extreme = read_pose(
      ConfigNode::parse(pose_yaml(hand_, state, {true}), "written"), hand_, hand_.rest_state());
  EXPECT_LT((extreme - state).cwiseAbs().maxCoeff(), 1e-5);
}

}  // namespace
}  // namespace hypotrack
