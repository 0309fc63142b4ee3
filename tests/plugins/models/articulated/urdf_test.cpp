#include <gmock/gmock.h>

#include <fstream>
#include <thread>

#include "description.hpp"
#include "expect_error.hpp"
#include "hypotrack/error.hpp"
#include "test_paths.hpp"

namespace hypotrack::articulated {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kLinks = "<link name='a'/><link name='b'/>";
constexpr const char* kLimit = "<limit lower='-1' upper='2' effort='1' velocity='1'/>";

std::string joint(const std::string& type, const std::string& inside) {
  return "<joint name='j' type='" + type + "'><parent link='a'/><child link='b'/>" + inside +
         "</joint>";
}

std::string visual(const std::string& inside) {
  return "<link name='a'><visual>" + inside + "</visual></link>";
}

class Urdf : public testing::Test {
 protected:
  Description read(const std::string& inside) {
    std::ofstream(file()) << "<robot name='it'>" << inside << "</robot>";
    return read_urdf(file());
  }
  std::string message(const std::string& inside) {
    const std::string found = test::message_of<DataError>([&] { read(inside); });
    EXPECT_THAT(found, StartsWith(file().string() + ": "));
    return found.substr(std::min(found.size(), file().string().size() + 2));
  }
  std::filesystem::path file() const { return folder_.path() / "it.urdf"; }

 private:
  test::TemporaryDirectory folder_;
};

TEST_F(Urdf, HasLinksJointsAndLimits) {
  const Description it = read(kLinks + joint("revolute",
                                             "<origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/>"
                                             "<axis xyz='0 0 1'/>" +
                                                 std::string(kLimit)));
  EXPECT_THAT(it.mechanism.links, testing::ElementsAre("a", "b"));
  ASSERT_EQ(it.mechanism.joints.size(), 1U);
  const Joint& joint = it.mechanism.joints[0];
  EXPECT_EQ(joint.name, "j");
  EXPECT_EQ(joint.kind, JointKind::revolute);
  EXPECT_EQ(joint.parent, "a");
  EXPECT_EQ(joint.child, "b");
  EXPECT_EQ(joint.lower, -1);
  EXPECT_EQ(joint.upper, 2);
  EXPECT_EQ(joint.axis, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(
      (joint.parent_from_child * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3)));
  EXPECT_FALSE(joint.mimic);
}

TEST_F(Urdf, HasJointsWithoutLimitsAndWithMimic) {
  const Description it =
      read(kLinks + joint("continuous", std::string(kLimit) + "<mimic joint='k' multiplier='-2' "
                                                              "offset='0.5'/>"));
  const Joint& joint = it.mechanism.joints[0];
  EXPECT_EQ(joint.kind, JointKind::continuous);
  EXPECT_TRUE(std::isinf(joint.upper)) << "limits of a continuous joint mean nothing";
  ASSERT_TRUE(joint.mimic);
  EXPECT_EQ(joint.mimic->joint, "k");
  EXPECT_EQ(joint.mimic->multiplier, -2);
  EXPECT_EQ(joint.mimic->offset, 0.5);
}

TEST_F(Urdf, HasShapesColoursAndFilesBesideItself) {
  const Description it = read(
      "<material name='red'><color rgba='1 0 0.5 1'/></material>"
      "<material name='wood'><texture filename='pictures/wood.png'/></material>" +
      visual("<geometry><box size='1 2 3'/></geometry><material name='red'/>") +
      "<link name='b'><visual><geometry><mesh filename='b.obj' scale='1 -1 2'/></geometry>"
      "<material name='wood'/></visual>"
      "<visual><geometry><cylinder radius='1' length='2'/></geometry></visual>"
      "<visual><geometry><sphere radius='3'/></geometry></visual>"
      "<collision><geometry><box size='9 9 9'/></geometry></collision></link>" +
      joint("fixed", ""));
  ASSERT_EQ(it.visuals.size(), 4U);
  EXPECT_EQ(it.visuals[0].kind, ShapeKind::box);
  EXPECT_EQ(it.visuals[0].color, Eigen::Vector3f(1, 0, 0.5f));
  EXPECT_EQ(it.visuals[1].mesh, file().parent_path() / "b.obj");
  EXPECT_EQ(it.visuals[1].size, Eigen::Vector3d(1, -1, 2));
  EXPECT_EQ(it.visuals[1].texture, file().parent_path() / "pictures/wood.png");
  EXPECT_EQ(it.visuals[2].kind, ShapeKind::cylinder);
  EXPECT_EQ(it.visuals[3].size[0], 3);
  EXPECT_EQ(it.visuals[3].link, 1U);
  EXPECT_EQ(it.visuals[3].name, "link 'b', visual 3");
}

TEST_F(Urdf, SaysWhatIsWrongWithTheFile) {
  EXPECT_EQ(message(""), "this is no valid URDF file: No link elements found in urdf file");
  EXPECT_THAT(message("<link name='a'>"), StartsWith("this is no valid URDF file: Error reading"));
  EXPECT_THAT(message("<link name='a'/><link name='a'/>"), HasSubstr("link 'a' is not unique"));
  EXPECT_THAT(message(kLinks), HasSubstr("Two root links found: [a] and [b]"));
  EXPECT_THAT(message(kLinks + joint("revolute", "")),
              HasSubstr("Joint [j] is of type REVOLUTE but it does not specify limits"));
  EXPECT_THAT(message(kLinks + joint("screw", kLimit)), HasSubstr("has no known type [screw]"));
  EXPECT_THAT(message(visual("<geometry><box size='1 nan 2'/></geometry>")),
              HasSubstr("Unable to parse component [nan] to a double"))
      << "urdfdom logs this and leaves the visual out";
  EXPECT_THAT(message(visual("<geometry><box size='1 1 1'/></geometry><material name='blue'/>")),
              HasSubstr("material 'blue' undefined"));
  EXPECT_THAT(message(kLinks + joint("revolute",
                                     "<limit lower='0' upper='1e999' effort='1' velocity='1'/>")),
              HasSubstr("upper value (1e999) is not a valid float"));
  EXPECT_THAT(message("<xacro:include filename='x'/>" + visual("")),
              EndsWith("this is a xacro macro file: write the URDF that `xacro` makes of it"));
}

TEST_F(Urdf, SaysWhatIsNotSupportedAndWhatToDo) {
  for (const std::string type : {"floating", "planar"})
    EXPECT_EQ(message(kLinks + joint(type, "")),
              "joint 'j': its type is " + type +
                  ", expected revolute, continuous, prismatic or fixed; write it as several of "
                  "these with links without a visual between them");
  EXPECT_EQ(
      message(visual("<geometry><mesh filename='package://lamp/a.obj'/></geometry>")),
      "link 'a', visual 1: ROS looks up 'package://lamp/a.obj' in its packages, hypotrack does "
      "not: write the path from the folder of the URDF file to that file");
  EXPECT_EQ(message(visual("<geometry><box size='1 0 2'/></geometry>")),
            "link 'a', visual 1: its size is 0 m, expected more than 0");
  EXPECT_EQ(message(visual("<geometry><sphere radius='-1'/></geometry>")),
            "link 'a', visual 1: its radius is -1 m, expected more than 0");
  EXPECT_EQ(message(visual("<geometry><mesh filename='a.obj' scale='1 0 1'/></geometry>")),
            "link 'a', visual 1: its scale has a 0, which leaves nothing");
}

TEST_F(Urdf, RefusesFilesThatAreMissingOrWouldExhaustTheStack) {
  EXPECT_THAT(test::message_of<DataError>([&] { read_urdf(file()); }),
              EndsWith("it.urdf: there is no such file"));
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_THAT(message(deep), HasSubstr("the file has more than 10000 elements"));
  EXPECT_THAT(message(std::string(5 << 20, ' ')), HasSubstr("it is larger than 4 MiB"));
}

TEST_F(Urdf, IsReadFromSeveralThreadsAtOnceWithItsOwnMessage) {
  test::TemporaryDirectory folder;
  std::vector<std::jthread> threads;
  std::array<std::string, 4> messages;
  for (std::size_t i = 0; i < messages.size(); ++i)
    threads.emplace_back([&, i] {
      const std::string name = "link_" + std::to_string(i);
      const auto own = folder.path() / (name + ".urdf");
      std::ofstream(own) << "<robot name='it'><link name='" << name << "'/><link name='" << name
                         << "'/></robot>";
      for (int round = 0; round < 20; ++round) {
        messages[i] = test::message_of<DataError>([&] { read_urdf(own); });
      }
    });
  threads.clear();
  for (std::size_t i = 0; i < messages.size(); ++i)
    EXPECT_THAT(messages[i],
                EndsWith("URDF file: link 'link_" + std::to_string(i) + "' is not unique"));
}

}  // namespace
}  // namespace hypotrack::articulated
