// Rotations that are given by directions which a model names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/pose.hpp"
#include "hypotrack/plugin/params.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using test::message_of;
using testing::AllOf;
using testing::HasSubstr;

/// A box whose sides have names.
class Chest final : public Model {
 public:
  explicit Chest(std::vector<NamedDirection> directions)
      : Model(test::make_test_box()), directions_(std::move(directions)) {}

 private:
  std::vector<NamedDirection> do_directions() const override { return directions_; }

  std::vector<NamedDirection> directions_;
};

std::shared_ptr<const Model> chest() {
  return std::make_shared<Chest>(std::vector<NamedDirection>{{"lid", Eigen::Vector3d::UnitY()},
                                                             {"front", Eigen::Vector3d::UnitZ()},
                                                             {"side", Eigen::Vector3d::UnitX()}});
}

class Directions : public testing::Test {
 protected:
  static Eigen::Matrix3d read(const Scene& scene, const std::string& rotation,
                              std::span<const Camera> cameras = {}) {
    const Eigen::VectorXd state =
        read_pose(ConfigNode::parse("{box: {" + rotation + "}}", "pose.yaml"), scene,
                  scene.rest_state(), cameras);
    return Eigen::Quaterniond(state[3], state[4], state[5], state[6]).toRotationMatrix();
  }
  std::string refusal(const std::string& rotation) const {
    return message_of<ConfigError>([&] { read(scene_, rotation); });
  }

  const Scene scene_{{{"box", chest()}}};
};

TEST_F(Directions, PointAsTheyAreGiven) {
  const Eigen::Matrix3d a = read(scene_, "rotation: {lid: up, front: to_camera}");
  EXPECT_TRUE(a.col(1).isApprox(-Eigen::Vector3d::UnitY(), 1e-12)) << a;
  EXPECT_TRUE(a.col(2).isApprox(-Eigen::Vector3d::UnitZ(), 1e-12)) << a;
  const Eigen::Matrix3d b = read(scene_, "rotation: {side: [0, 0, 5], lid: left}");
  EXPECT_TRUE(b.col(0).isApprox(Eigen::Vector3d::UnitZ(), 1e-12)) << b;
  EXPECT_TRUE(b.col(1).isApprox(-Eigen::Vector3d::UnitX(), 1e-12)) << b;
}

TEST_F(Directions, AreThoseThatTheFirstCameraSees) {
  Camera camera;
  camera.camera_from_world.linear() =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d seen = camera.camera_from_world.linear() *
                               read(scene_, "rotation: {lid: up, front: to_camera}", {&camera, 1});
  EXPECT_TRUE(seen.col(1).isApprox(-Eigen::Vector3d::UnitY(), 1e-12)) << seen;
}

TEST_F(Directions, TurnAlikeUntilTheyArePerpendicular) {
  const Eigen::Matrix3d turned = read(scene_, "rotation: {front: [0, 0, -1], lid: [0, -1, 0.36]}");
  const double half = std::atan(0.36) / 2;
  EXPECT_NEAR(std::atan2(turned(2, 1), -turned(1, 1)), half, 1e-12);
  EXPECT_NEAR(std::atan2(-turned(1, 2), -turned(2, 2)), half, 1e-12);
}

TEST_F(Directions, AreRefusedIfTheyGiveNoRotation) {
  EXPECT_THAT(refusal("rotation: {lid: up, front: up}"),
              AllOf(HasSubstr("pose.yaml:1:"), HasSubstr("lid and front are 0 degrees apart"),
                    HasSubstr("60 to 120 degrees")));
  EXPECT_THAT(refusal("rotation: {lid: up}"),
              HasSubstr("gives 1 of the directions lid, front, side; expected two"));
  EXPECT_THAT(refusal("rotation: {lid: up, front: away, side: left}"), HasSubstr("gives 3 of"));
  EXPECT_THAT(refusal("rotation: {lid: up, frond: away}"), HasSubstr("did you mean 'front'?"));
  EXPECT_THAT(refusal("rotation: {lid: upp, front: away}"), HasSubstr("did you mean 'up'?"));
  EXPECT_THAT(refusal("rotation_deg: [0, 0, 0], rotation: {lid: up, front: away}"),
              HasSubstr("both rotation_deg and rotation are given"));
}

TEST_F(Directions, AreRefusedOfModelsThatNameNone) {
  const Scene box({{"box", std::make_shared<Model>(test::make_test_box())}});
  EXPECT_THAT(
      message_of<ConfigError>([&] { read(box, "rotation: {lid: up, front: away}"); }),
      AllOf(HasSubstr("'box' has no directions to point by name"), HasSubstr("rotation_deg")));
}

TEST_F(Directions, OfAFaultyModelAreRefused) {
  const auto faulty = [](std::vector<NamedDirection> all) {
    Chest model(std::move(all));
    model.set_label("model 'chest'");
    return message_of<PluginError>([&] { (void)model.directions(); });
  };
  const NamedDirection lid{"lid", Eigen::Vector3d::UnitY()};
  for (const NamedDirection& other :
       {NamedDirection{"front", {0, 0, 2}}, NamedDirection{"lid", Eigen::Vector3d::UnitZ()},
        NamedDirection{"", Eigen::Vector3d::UnitZ()}, NamedDirection{"front", {0, 0.6, 0.8}},
        NamedDirection{"front", Eigen::Vector3d::Constant(std::nan(""))}})
    EXPECT_THAT(faulty({lid, other}),
                AllOf(HasSubstr("model 'chest': its direction '" + other.name + "' is"),
                      HasSubstr("perpendicular to each other; this is a bug in the model")));
}

}  // namespace
}  // namespace hypotrack
