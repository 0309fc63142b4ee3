#include <gmock/gmock.h>

#include <fstream>
#include <thread>

#include "description.hpp"
#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
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

std::string mesh(const std::string& file) {
  return "<geometry><mesh filename='" + file + "'/></geometry>";
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
  std::filesystem::path file() const { return folder_.path() / name_; }
  std::filesystem::path folder() const { return folder_.path(); }
  /// Sets where the file is, relative to the folder.
  void place(const std::string& name) { name_ = name; }

 private:
  test::TemporaryDirectory folder_;
  std::string name_ = "it.urdf";
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

TEST_F(Urdf, LimitsNeedNoEffortAndNoVelocity) {
  for (const std::string limit :
       {"<limit lower='-1' upper='2'/>", "<limit upper='2' velocity='3' lower='-1'></limit>",
        "<limit\n lower='-1' effort='7' upper='2'/>"}) {
    const Description it = read(kLinks + joint("revolute", limit));
    EXPECT_EQ(it.mechanism.joints.at(0).lower, -1) << limit;
    EXPECT_EQ(it.mechanism.joints.at(0).upper, 2) << limit;
  }
}

TEST_F(Urdf, CollisionGeometryAndCommentsAreNotRead) {
  const Description it = read(
      "<link name='a'><collision><geometry><plane normal='0 0 1'/></geometry></collision>"
      "<!-- <collision> <limit --><visual><geometry><sphere radius='2'/></geometry></visual>"
      "<collision/><collision_checking/></link>");
  ASSERT_EQ(it.visuals.size(), 1U);
  EXPECT_EQ(it.visuals[0].size[0], 2);
  EXPECT_THAT(message("<link name='a'/><link name='b'/><!-- "), HasSubstr("no valid URDF file"));
  EXPECT_EQ(read("<link name='a'><collision name='a/>'/><collision name=\"it's\"><!-- </collision>"
                 "--><geometry/></collision ><visual><geometry><sphere radius='2'/></geometry>"
                 "</visual><collision></collision></link>")
                .visuals.size(),
            1U);
}

TEST_F(Urdf, MassesAreNotRead) {
  for (const std::string inertial : {"<mass value='1'/>", "<inertia ixx='1'/>",
                                     "<mass value='nan'/><origin xyz='a b c'/>", ""}) {
    const Description it = read(
        "<link name='a'><inertial>" + inertial +
        "</inertial><inertial/><visual><geometry><sphere radius='2'/></geometry></visual></link>");
    EXPECT_EQ(it.visuals.size(), 1U) << inertial;
    EXPECT_THAT(it.notes, testing::IsEmpty()) << inertial;
  }
}

TEST_F(Urdf, OneNoteNamesWhatIsNotRead) {
  const Description it = read(
      "<!-- <mine/> --><link name='a'><visual><origin xyz='0 0 0' quat_xyzw='0 0 1 0'/>"
      "<geometry><sphere radius='2'/></geometry><material name='m'><color rgba='1 0 0 0.5'/>"
      "</material></visual><collision name='c'><mine/></collision></link><link name='b'/>" +
      joint("revolute",
            std::string(kLimit) + "<safety_controller k_position='1'/><dynamics friction='x'/>") +
      "<gazebo reference='a'><mine/></gazebo><gazebo/><transmission name='t'><joint name='j'/>"
      "</transmission><theirs/>");
  EXPECT_THAT(it.notes,
              testing::ElementsAre(
                  file().string() +
                  ": not read: <gazebo> (2 times), <safety_controller>, <theirs>, <transmission>, "
                  "the attribute quat_xyzw of <origin>, the transparency of <color>"));
}

TEST_F(Urdf, AScaleIsAFactorOnAllLengths) {
  const std::string origin = "<origin xyz='1 2 3' rpy='0 0 1'/>";
  std::ofstream(file())
      << "<robot name='it'>" + visual(origin + "<geometry><box size='1 2 3'/></geometry>") +
             "<link name='b'/><link name='c'/><link name='d'/>" +
             joint("prismatic", origin + kLimit) +
             "<joint name='k' type='revolute'><parent link='b'/><child link='c'/>"
             "<mimic joint='j' multiplier='4' offset='1'/>" +
             kLimit +
             "</joint>"
             "<joint name='l' type='prismatic'><parent link='c'/><child link='d'/>"
             "<mimic joint='j' multiplier='4' offset='1'/>" +
             kLimit + "</joint></robot>";
  const Description it = read_urdf(file(), 0.5);
  EXPECT_EQ(it.visuals[0].size, Eigen::Vector3d(0.5, 1, 1.5));
  EXPECT_EQ(it.visuals[0].link_from_visual.translation(), Eigen::Vector3d(0.5, 1, 1.5));
  const Joint& slider = it.mechanism.joints.at(0);
  EXPECT_EQ(slider.parent_from_child.translation(), Eigen::Vector3d(0.5, 1, 1.5));
  EXPECT_EQ(slider.upper, 1);
  const Joint& turned = it.mechanism.joints.at(1);
  EXPECT_EQ(turned.upper, 2);
  EXPECT_EQ(turned.mimic->multiplier, 8);  // radians per metre
  EXPECT_EQ(turned.mimic->offset, 1);
  const Joint& second = it.mechanism.joints.at(2);
  EXPECT_EQ(second.mimic->multiplier, 4);
  EXPECT_EQ(second.mimic->offset, 0.5);
}

TEST_F(Urdf, SaysWhatIsWrongWithTheFile) {
  std::ofstream(file()) << "\xFF\xFE<\0r";
  EXPECT_THAT(test::message_of<DataError>([&] { read_urdf(file()); }),
              EndsWith("the file is in UTF-16; write it in UTF-8"));
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
  EXPECT_THAT(message(visual("<geometry><capsule radius='1' length='2'/></geometry>")),
              AllOf(HasSubstr("Unknown geometry type 'capsule'"),
                    HasSubstr("a <geometry> is a <box>, <cylinder>, <sphere> or <mesh>: make a "
                              "capsule of a cylinder and two spheres")));
  EXPECT_THAT(message("<xacro:include filename='x'/>" + visual("")),
              EndsWith("this is a xacro macro file: write the URDF that `xacro` makes of it"));
}

TEST_F(Urdf, SaysWhatIsNotSupportedAndWhatToDo) {
  for (const std::string type : {"floating", "planar"})
    EXPECT_EQ(message(kLinks + joint(type, "")),
              "joint 'j': its type is " + type +
                  ", expected revolute, continuous, prismatic or fixed; write it as several of "
                  "these with links without a visual between them");
  EXPECT_EQ(message(visual(mesh("model://lamp/a.obj"))),
            "link 'a', visual 1: found 'model://lamp/a.obj', expected a path relative to the URDF "
            "file, package://NAME/FILE or file://FILE");
  EXPECT_EQ(message(visual("<geometry><box size='1 0 2'/></geometry>")),
            "link 'a', visual 1: its size is 0 m, expected more than 0");
  EXPECT_EQ(message(visual("<geometry><sphere radius='-1'/></geometry>")),
            "link 'a', visual 1: its radius is -1 m, expected more than 0");
  EXPECT_EQ(message(visual("<geometry><mesh filename='a.obj' scale='1 0 1'/></geometry>")),
            "link 'a', visual 1: its scale has a 0, which leaves nothing");
}

TEST_F(Urdf, FindsThePackageOfAMeshAboveTheFileOrBesideAFolderAboveIt) {
  const std::filesystem::path shelf = folder(), lamp = shelf / "lamp";
  std::filesystem::create_directories(lamp / "urdf");
  std::filesystem::create_directories(shelf / "bulbs");
  place("lamp/urdf/it.urdf");
  EXPECT_EQ(read(visual(mesh("package://lamp/meshes/a.obj"))).visuals[0].mesh,
            lamp / "meshes/a.obj");
  EXPECT_EQ(read(visual(mesh("package://bulbs/b.obj"))).visuals[0].mesh, shelf / "bulbs/b.obj");
  EXPECT_EQ(read(visual(mesh("package://bulbs//b.obj"))).visuals[0].mesh, shelf / "bulbs/b.obj");
}

TEST_F(Urdf, SaysWhereItLookedForAPackage) {
  EXPECT_EQ(message(visual(mesh("package://lamp/a.obj"))),
            "link 'a', visual 1: found no folder 'lamp' for 'package://lamp' beside the URDF file "
            "or above it; put the package there, or write a path relative to the file");
  for (const std::string name : {"package://", "package://lamp", "package:///a.obj"})
    EXPECT_EQ(message(visual(mesh(name))),
              "link 'a', visual 1: found '" + name + "', expected package://NAME/FILE");
  EXPECT_THAT(message(visual(mesh("$(find lamp)/a.obj"))),
              HasSubstr("'$(find lamp)/a.obj', which is for xacro: write the URDF that `xacro`"));
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
