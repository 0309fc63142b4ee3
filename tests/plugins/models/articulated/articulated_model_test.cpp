#include <gmock/gmock.h>

#include <fstream>

#include "../model_plugins.hpp"
#include "scene/mesh_topology.hpp"

namespace hypotrack::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string object(const std::string& name) {
  return "{type: articulated, file: '" + (source_dir() / "configs/objects" / name).string() + "'";
}

std::vector<std::string> joints_of(const Model& model) {
  std::vector<std::string> names;
  for (std::size_t i = kPoseSize; i < model.data().parameters.size(); ++i)
    names.push_back(model.data().parameters[i].name);
  return names;
}

TEST(ArticulatedModel, ObjectsOfOursHaveTheirJointsAndClosedSurfaces) {
  for (const auto& [file, joint] :
       {std::pair{"scissors.urdf", "half_opening"}, std::pair{"drawer.urdf", "opening"},
        std::pair{"laptop.urdf", "hinge"}}) {
    const auto model = make_model(object(file) + "}");
    EXPECT_EQ(joints_of(*model), std::vector<std::string>{joint}) << file;
    EXPECT_TRUE(is_closed_outwards(model->data().mesh)) << file;
    EXPECT_FALSE(model->data().mesh.texture.empty()) << file;
  }
}

TEST(ArticulatedModel, BladesOfScissorsOpenAlike) {
  const auto model = make_model(object("scissors.urdf") + ", anchors: [" +
                                "{name: right, link: right, position_mm: [0, 90, 0]}, "
                                "{name: left, link: left, position_mm: [0, 90, 0]}]}");
  for (const double degrees : {0.0, 10.0, 35.0}) {
    const Degrees opening{{"half_opening", degrees}};
    const Eigen::Vector3d right = model_landmark(*model, "right", opening);
    const Eigen::Vector3d left = model_landmark(*model, "left", opening);
    EXPECT_NEAR(right.x(), -0.09 * std::sin(degrees * kDegree), 1e-9);
    EXPECT_NEAR(left.x(), -right.x(), 1e-9);
    EXPECT_NEAR(left.y(), right.y(), 1e-9);
  }
}

TEST(ArticulatedModel, HasThreeLandmarksPerLinkThatMoves) {
  const auto model = make_model(object("drawer.urdf") + "}");
  std::vector<std::string> names;
  for (const Landmark& landmark : model->data().landmarks) names.push_back(landmark.name);
  EXPECT_THAT(names, testing::ElementsAre("cabinet_center", "cabinet_end_x", "cabinet_end_y",
                                          "drawer_center", "drawer_end_x", "drawer_end_y"));
}

TEST(ArticulatedModel, HasTheDirectionsOfARobotsHandByItsAnchors) {
  const auto hand = make_model(object("laptop.urdf") + ", anchors: [" +
                               "{name: wrist, link: base, position_mm: [0, 80, 0]}, "
                               "{name: index_mcp, link: base, position_mm: [-50, -40, 0]}, "
                               "{name: little_mcp, link: base, position_mm: [50, -40, 0]}, "
                               "{name: middle_tip, link: lid, position_mm: [0, -150, 0]}]}");
  const std::vector<NamedDirection> all = hand->directions();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "palm");
  EXPECT_TRUE(all[0].axis.isApprox(Eigen::Vector3d::UnitZ(), 1e-12)) << all[0].axis;
  EXPECT_EQ(all[1].name, "fingers");
  EXPECT_TRUE(all[1].axis.isApprox(-Eigen::Vector3d::UnitY(), 1e-12)) << all[1].axis;
  EXPECT_TRUE(make_model(object("laptop.urdf") + "}")->directions().empty());
}

TEST(ArticulatedModel, SaysWhichParametersAFileNeeds) {
  EXPECT_THAT(model_error("{type: articulated}"), HasSubstr("file"));
  EXPECT_THAT(model_error("{type: articulated, file: lamp.glb}"),
              AllOf(HasSubstr("scene.yaml:1:1"), HasSubstr("lamp.glb needs a `rig`")));
  EXPECT_THAT(model_error(object("drawer.urdf") + ", rig: lamp.yaml}"),
              AllOf(HasSubstr("a URDF file takes no `rig`"), HasSubstr("lamp.yaml")));
  EXPECT_THAT(model_error(object("drawer.urdf") +
                          ", anchors: [{name: a, link: door, position_mm: [0, 0, 0]}]}"),
              HasSubstr("the anchor 'a' is on the link 'door', which there is not; the links are: "
                        "cabinet, drawer, knob"));
}

/// A URDF file of one link with this inside its only <visual>.
std::string error_of_visual(const std::string& inside) {
  const TemporaryDirectory folder;
  const auto file = folder.path() / "it.urdf";
  std::ofstream(folder.path() / "empty.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  std::ofstream(folder.path() / "large.obj") << "v 0 0 0\nv 50 0 0\nv 0 50 0\nf 1 2 3\n";
  std::ofstream(file) << "<robot name='it'><link name='a'>" << inside << "</link></robot>";
  return model_error("{type: articulated, file: '" + file.string() + "'}");
}

TEST(ArticulatedModel, RefusesWhatCannotBeDrawn) {
  EXPECT_THAT(
      error_of_visual("<collision><geometry><box size='1 1 1'/></geometry></collision>"),
      HasSubstr("no link has a <visual>, so there is nothing to draw; collision geometry is "
                "not used: copy it to <visual> elements"));
  const auto mesh = [](const std::string& name) {
    return "<visual><geometry><mesh filename='" + name + "'/></geometry></visual>";
  };
  EXPECT_THAT(error_of_visual(mesh("none.obj")),
              AllOf(HasSubstr("it.urdf: link 'a', visual 1: "), HasSubstr("no such mesh file")));
  EXPECT_THAT(error_of_visual(mesh("empty.obj")),
              AllOf(HasSubstr("it.urdf: link 'a', visual 1: "), HasSubstr("empty.obj")));
  EXPECT_THAT(error_of_visual(mesh("a.3ds")),
              AllOf(HasSubstr("it.urdf: link 'a', visual 1: "), HasSubstr("OBJ, PLY, STL")));
  EXPECT_THAT(error_of_visual(mesh("large.obj")), AllOf(HasSubstr("the object is 50 m long"),
                                                        HasSubstr("scale=\"0.001 0.001 0.001\"")));
  EXPECT_THAT(
      error_of_visual("<visual><geometry><box size='1 1 1'/></geometry>"
                      "<material name='m'><texture filename='no.png'/></material></visual>"),
      AllOf(HasSubstr("it.urdf: link 'a', visual 1: its texture "), HasSubstr("no.png")));
}

/// Returns the mesh of a blue visual whose DAE file has a material, bound by `binding`.
Mesh blue_visual_of_dae(const std::string& binding) {
  const TemporaryDirectory folder;
  const auto file = folder.path() / "it.urdf";
  std::ofstream(folder.path() / "a.dae")
      << "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>"
         "<asset><unit meter='0.001'/><up_axis>Z_UP</up_axis></asset><library_effects>"
         "<effect id='e'><profile_COMMON><technique sid='t'><lambert><diffuse><color>0.8 0.1 0.2 1"
         "</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
         "<library_materials><material id='m'><instance_effect url='#e'/></material>"
         "</library_materials><library_geometries><geometry id='g'><mesh><source id='p'>"
         "<float_array id='a' count='9'>0 0 0 100 0 0 0 200 0</float_array><technique_common>"
         "<accessor source='#a' count='3' stride='3'><param name='X' type='float'/><param name='Y' "
         "type='float'/><param name='Z' type='float'/></accessor></technique_common></source>"
         "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices><triangles count='1' "
         "material='s'><input semantic='VERTEX' source='#v' offset='0'/><p>0 1 2</p></triangles>"
         "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id='w'>"
         "<node><instance_geometry url='#g'>"
      << binding
      << "</instance_geometry></node></visual_scene></"
         "library_visual_scenes><scene><instance_visual_scene url='#w'/></scene>"
         "</COLLADA>";
  std::ofstream(file)
      << "<robot name='it'><link name='a'><visual><geometry><mesh filename='a.dae'/></geometry>"
         "<material name='m'><color rgba='0 0 1 1'/></material></visual></link></robot>";
  return make_model("{type: articulated, file: '" + file.string() + "'}")->data().mesh;
}

TEST(ArticulatedModel, DaeMeshesAreInMetresAndKeepTheirColor) {
  const Mesh mesh = blue_visual_of_dae(
      "<bind_material><technique_common><instance_material symbol='s' target='#m'/>"
      "</technique_common></bind_material>");
  EXPECT_EQ(mesh.color, Eigen::Vector3f(0.8f, 0.1f, 0.2f));
  EXPECT_TRUE(mesh.vertices.rowwise().maxCoeff().isApprox(Eigen::Vector3f(0.1f, 0.2f, 0)));
}

TEST(ArticulatedModel, DaeMeshesWithoutMaterialsTakeThatOfTheVisual) {
  EXPECT_EQ(blue_visual_of_dae("").color, Eigen::Vector3f(0, 0, 1));
}

TEST(ArticulatedModel, MirroredScalesKeepTheOutsideOutside) {
  const TemporaryDirectory folder;
  const auto file = folder.path() / "it.urdf";
  std::ofstream(folder.path() / "a.obj")
      << "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  std::ofstream(file)
      << "<robot name='it'><link name='a'><visual><geometry>"
         "<mesh filename='a.obj' scale='-1 2 1'/></geometry></visual></link></robot>";
  const auto model = make_model("{type: articulated, file: '" + file.string() + "'}");
  EXPECT_TRUE(is_closed_outwards(model->data().mesh));
  EXPECT_NEAR(model->data().mesh.vertices.row(0).minCoeff(), -0.1f, 1e-6f);
  EXPECT_NEAR(model->data().mesh.vertices.row(1).maxCoeff(), 0.2f, 1e-6f);
}

}  // namespace
}  // namespace hypotrack::test
