#include "mechanism.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::articulated {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

Joint joint(const std::string& name, JointKind kind, const std::string& parent,
            const std::string& child, const Vector3d& at, const Vector3d& axis) {
  Joint out{.name = name, .kind = kind};
  out.parent = parent;
  out.child = child;
  out.parent_from_child.translation() = at;
  out.axis = axis;
  if (kind != JointKind::continuous) {
    out.lower = -2;
    out.upper = 2;
  }
  return out;
}

/// A wall with a door that turns about z, a latch that slides on it along x, a plate that is fixed
/// to the latch, and a wheel on the wall that turns without end about x.
Mechanism door() {
  using enum JointKind;
  return {{"plate", "wall", "door", "latch", "wheel"},
          {joint("bolts", fixed, "latch", "plate", {0, 0, 0.1}, {0, 0, 0}),
           joint("hinge", revolute, "wall", "door", {1, 0, 0}, {0, 0, 2}),
           joint("slide", prismatic, "door", "latch", {0, 2, 0}, {1, 0, 0}),
           joint("spin", continuous, "wall", "wheel", {0, 0, 3}, {1, 0, 0})}};
}

/// World positions of points on links, for values of the joints.
Vector3d point(const Assembly& assembly, std::size_t link, const Vector3d& on_link,
               std::initializer_list<double> joints) {
  std::vector<double> parameters{0, 0, 0, 1, 0, 0, 0};
  parameters.insert(parameters.end(), joints);
  const LinkPlace& place = assembly.links[link];
  return world_from_bones(assembly.data, parameters)[static_cast<std::size_t>(place.bone)] *
         place.bone_from_link * on_link;
}

void expect_near(const Vector3d& found, const Vector3d& expected) {
  EXPECT_LT((found - expected).norm(), 1e-12) << found.transpose();
}

std::string message(const Mechanism& mechanism) {
  return test::message_of<DataError>([&] { assemble(mechanism, "door.urdf"); });
}

TEST(Mechanism, HasAParameterPerMovingJointWithItsNameAndLimits) {
  const Assembly assembly = assemble(door(), "door.urdf");
  const auto& parameters = assembly.data.parameters;
  ASSERT_EQ(parameters.size(), 10U);
  EXPECT_EQ(parameters[7].name, "hinge");
  EXPECT_EQ(parameters[7].kind, ParameterKind::angle);
  EXPECT_EQ(parameters[7].lower, -2);
  EXPECT_EQ(parameters[8].name, "slide");
  EXPECT_EQ(parameters[8].kind, ParameterKind::length);
  EXPECT_EQ(parameters[9].name, "spin");
  EXPECT_TRUE(std::isinf(parameters[9].upper));
}

TEST(Mechanism, LinksThatAreFixedShareABone) {
  const Assembly assembly = assemble(door(), "door.urdf");
  EXPECT_EQ(assembly.data.bones.size(), 4U);
  EXPECT_EQ(assembly.links[0].bone, assembly.links[3].bone) << "plate and latch";
  EXPECT_EQ(assembly.data.bones[0].name, "wall") << "the root, wherever the file has it";
}

TEST(Mechanism, MovesLinksAsTheJointsSay) {
  const Assembly assembly = assemble(door(), "door.urdf");
  expect_near(point(assembly, 0, {0, 0, 0}, {0, 0, 0}), {1, 2, 0.1});
  // The door turns +x to +y and +y to -x; the latch slides along the door's x.
  expect_near(point(assembly, 0, {0, 0, 0}, {kPi / 2, 0.5, 0}), {1 - 2, 0.5, 0.1});
  expect_near(point(assembly, 4, {0, 1, 0}, {0, 0, kPi / 2}), {0, 0, 4});
}

TEST(Mechanism, StandsAsInTheFileWhereAJointHasItsBindValue) {
  Mechanism mechanism = door();
  mechanism.joints[1].bind = 0.5;
  mechanism.joints[1].lower = 0.2;
  const Assembly assembly = assemble(mechanism, "door.urdf");
  expect_near(point(assembly, 3, {0, 0, 0}, {0.5, 0, 0}), {1, 2, 0});
  EXPECT_EQ(assembly.data.parameters[7].rest, 0.2) << "0 is not within the limits";
}

TEST(Mechanism, JointsMimicOthersByMultipleAndOffset) {
  Mechanism mechanism = door();
  mechanism.joints[3].mimic = Mimic{"hinge", -2, 0.5};
  mechanism.joints[2].mimic = Mimic{"spin", 0.1, 0.2};  // 0.1 * (-2 * hinge + 0.5) + 0.2
  const Assembly assembly = assemble(mechanism, "door.urdf");
  ASSERT_EQ(assembly.data.parameters.size(), 8U);
  const double hinge = 0.25;
  const double spin = -2 * hinge + 0.5, slide = 0.1 * spin + 0.2;
  expect_near(point(assembly, 4, {0, 1, 0}, {hinge}), {0, std::cos(spin), 3 + std::sin(spin)});
  const Vector3d on_door(slide, 2, 0);
  expect_near(point(assembly, 3, {0, 0, 0}, {hinge}),
              Vector3d(1, 0, 0) + Eigen::AngleAxisd(hinge, Vector3d::UnitZ()) * on_door);
}

TEST(Mechanism, AMultipleOfZeroIsAFixedPlace) {
  Mechanism mechanism = door();
  mechanism.joints[2].mimic = Mimic{"hinge", 0, 0.3};
  const Assembly assembly = assemble(mechanism, "door.urdf");
  expect_near(point(assembly, 3, {0, 0, 0}, {0, 0}), {1.3, 2, 0});
}

TEST(Mechanism, IsRefusedUnlessItIsATree) {
  Mechanism twice = door();
  twice.joints.push_back(
      joint("rod", JointKind::fixed, "wheel", "plate", Vector3d::Zero(), Vector3d::UnitX()));
  EXPECT_EQ(
      message(twice),
      "door.urdf: the link 'plate' is the child of both joint 'bolts' and joint 'rod': closed "
      "loops are not supported; leave one of the joints out");
  Mechanism apart = door();
  apart.joints.erase(apart.joints.begin() + 1);
  EXPECT_THAT(message(apart), HasSubstr("the links 'wall', 'door' are children of no joint"));
  Mechanism cycle = door();
  cycle.joints[1].parent = "latch";
  EXPECT_THAT(message(cycle),
              HasSubstr("the links 'door', 'latch', 'plate' hang on each other in a cycle"));
  Mechanism ring = {{"a", "b"}, {}};
  ring.joints = {joint("j", JointKind::fixed, "a", "b", {0, 0, 0}, {1, 0, 0}),
                 joint("k", JointKind::fixed, "b", "a", {0, 0, 0}, {1, 0, 0})};
  EXPECT_THAT(message(ring), HasSubstr("every link is the child of another"));
  Mechanism unknown = door();
  unknown.joints[0].child = "sign";
  EXPECT_THAT(message(unknown),
              HasSubstr("joint 'bolts' joins the link 'sign', which there is not; the links are: "
                        "plate, wall, door, latch, wheel"));
  Mechanism names = door();
  names.joints[0].name = "hinge";
  EXPECT_THAT(message(names), HasSubstr("two joints are called 'hinge'"));
  names = door();
  names.links[0] = "wall";
  EXPECT_THAT(message(names), HasSubstr("two links are called 'wall'"));
}

TEST(Mechanism, IsRefusedIfAJointCannotMoveAsItSays) {
  const auto with = [](auto change) {
    Mechanism mechanism = door();
    change(mechanism.joints);
    return message(mechanism);
  };
  EXPECT_EQ(
      with([](auto& joints) {
        joints[2].mimic = Mimic{"handle", 1, 0};
      }),
      "door.urdf: joint 'slide' mimics 'handle', which is no joint that moves; those that can "
      "be mimicked are: hinge, spin");
  EXPECT_THAT(with([](auto& joints) {
                joints[2].mimic = Mimic{"bolts", 1, 0};
              }),
              HasSubstr("joint 'slide' mimics 'bolts', which is no joint that moves"));
  EXPECT_THAT(with([](auto& joints) {
                joints[2].mimic = Mimic{"spin", 1, 0};
                joints[3].mimic = Mimic{"slide", 1, 0};
              }),
              HasSubstr("joint 'slide' mimics itself by way of others"));
  EXPECT_THAT(with([](auto& joints) {
                joints[2].mimic = Mimic{"spin", std::numeric_limits<double>::quiet_NaN(), 0};
              }),
              HasSubstr("joint 'slide' mimics another with a number that is not finite"));
  EXPECT_THAT(with([](auto& joints) { joints[1].axis.setZero(); }),
              HasSubstr("joint 'hinge' has an axis of length 0"));
  EXPECT_THAT(with([](auto& joints) { joints[1].lower = joints[1].upper; }),
              HasSubstr("joint 'hinge' has the limits 2 to 2, which leave it no room"));
}

}  // namespace
}  // namespace hypotrack::articulated
