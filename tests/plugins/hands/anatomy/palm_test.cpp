#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/pose.hpp"
#include "hypotrack/plugin/params.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using testing::AllOf;
using testing::HasSubstr;

/// The scene of one hand that ships with hypotrack.
class PalmRotation : public testing::Test {
 protected:
  static Scene scene_of(const std::string& model) {
    return Scene({{"hand", std::shared_ptr<const Model>(
                               PluginLoader().make<Model>(ConfigNode::parse(model, "test")))}});
  }
  static Eigen::VectorXd read(const Scene& scene, const std::string& rotation) {
    return read_pose(ConfigNode::parse("{hand: {" + rotation + "}}", "pose.yaml"), scene,
                     scene.rest_state());
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

TEST_F(PalmRotation, OfAPalmToTheCameraIsTheHalfTurnAboutX) {
  const Eigen::VectorXd words = read(hand_, "rotation: {palm: to_camera, fingers: up}");
  const Eigen::VectorXd degrees = read(hand_, "rotation_deg: [180, 0, 0]");
  EXPECT_NEAR(words.segment<4>(3).norm(), 1, 1e-12);
  EXPECT_GT(std::abs(words.segment<4>(3).dot(degrees.segment<4>(3))), std::cos(5 * kDegree));
}

TEST_F(PalmRotation, PointsAnyHandAsItSays) {
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

/// A paw whose sole is no palm.
class Paw final : public Model {
 public:
  Paw() : Model(test::make_test_box()) {}

 private:
  std::vector<NamedDirection> do_directions() const override {
    return {{"sole", {0.6, 0, 0.8}}, {"claws", Eigen::Vector3d::UnitY()}};
  }
};

TEST(MirroredDirections, AreThoseOfTheOriginalIfItIsNoHand) {
  PluginLoader plugins;
  plugins.add(program_plugin<Model>("paw", [](PluginContext&) { return std::make_unique<Paw>(); }));
  const auto left =
      plugins.make<Model>(ConfigNode::parse("{type: mirrored_hand, of: {type: paw}}", "test"));
  ASSERT_EQ(left->directions().size(), 2U);
  EXPECT_EQ(left->directions()[0].name, "sole");
  EXPECT_EQ(left->directions()[0].axis, Eigen::Vector3d(-0.6, 0, 0.8));
  EXPECT_EQ(left->directions()[1].axis, Eigen::Vector3d::UnitY());
}

TEST(ClearLandmarks, OfHandsAreThoseOfThePalmFirst) {
  for (const char* hand : {"{type: hand}", "{type: mirrored_hand}"}) {
    const auto model = PluginLoader().make<Model>(ConfigNode::parse(hand, "test"));
    const std::vector<std::string> clear = model->clear_landmarks();
    ASSERT_EQ(clear.size(), 10U) << hand;
    EXPECT_EQ(clear.front(), "wrist") << hand;
    for (const std::string& name : clear)
      EXPECT_TRUE(std::ranges::count(model->data().landmarks, name, &Landmark::name) == 1) << name;
  }
}

TEST_F(PalmRotation, IsRefusedIfItIsNone) {
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
  const Scene box = scene_of("{type: rigid_box, size_mm: [60, 80, 100]}");
  EXPECT_THAT(refusal(box, "rotation: {palm: away, fingers: up}"),
              AllOf(HasSubstr("no directions"), HasSubstr("rotation_deg")));
}

TEST_F(PalmRotation, SurvivesWritingAndReadingAPose) {
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
