#include "object_rig.hpp"

#include <gmock/gmock.h>

#include <map>

#include "expect_error.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "stick_hand.hpp"

namespace hypotrack::articulated {
namespace {

using testing::HasSubstr;

ModelData rigged(const std::string& yaml) {
  return rig_object(test::stick_hand(),
                    ParamReader(ConfigNode::parse(yaml, "sticks.yaml")).read<ObjectRig>(),
                    "sticks.yaml")
      .data;
}

std::string message(const std::string& yaml) {
  return test::message_of<Error>([&] { rigged(yaml); });
}

/// The largest motion of the vertices that a file bone's triangle has, and of all others.
struct Moved {
  double own = 0, others = 0;
};
Moved moved(const ModelData& data, const std::vector<double>& parameters, const std::string& bone) {
  const ImportedMesh file = test::stick_hand();
  std::vector<double> rest;
  for (const Parameter& p : data.parameters) rest.push_back(p.rest);
  const Model model(data);
  const Eigen::VectorXf far =
      (posed_vertices(model, parameters) - posed_vertices(model, rest)).colwise().norm();
  Moved out;
  for (Eigen::Index v = 0; v < far.size(); ++v) {
    const auto& name = file.bones[static_cast<std::size_t>(file.mesh.bone_indices(0, v))].name;
    double& most = name.starts_with(bone) ? out.own : out.others;
    most = std::max(most, static_cast<double>(far[v]));
  }
  return out;
}

TEST(ObjectRig, GivesParametersAnyNamesAndMovesTheBonesThatItNames) {
  const ModelData data = rigged(
      "joints:\n"
      "  - {name: lid, bone: index_1, axis: [1, 0, 0], bounds_deg: [-10, 90]}\n"
      "  - {name: tray, bone: little_1, type: prismatic, axis: [0, 2, 0], bounds_mm: [0, 50]}\n"
      "  - {name: fan, bone: thumb_1, type: continuous, axis: [0, 0, 1]}\n");
  ASSERT_EQ(data.parameters.size(), 10U);
  std::map<std::string, std::size_t> at;
  for (std::size_t i = 7; i < 10; ++i) at[data.parameters[i].name] = i;
  EXPECT_NEAR(data.parameters[at.at("lid")].upper, 90 * kDegree, 1e-12);
  EXPECT_EQ(data.parameters[at.at("tray")].kind, ParameterKind::length);
  EXPECT_NEAR(data.parameters[at.at("tray")].upper, 0.05, 1e-12);
  EXPECT_TRUE(std::isinf(data.parameters[at.at("fan")].lower));
  EXPECT_EQ(data.bones.size(), 4U) << "what does not move is one bone";
  const auto with = [&](const std::string& name, double value) {
    std::vector<double> parameters{0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    parameters[at.at(name)] = value;
    return parameters;
  };
  const Moved lid = moved(data, with("lid", 0.5), "index_");
  EXPECT_GT(lid.own, 0.01);
  EXPECT_LT(lid.others, 1e-6);
  const Moved tray = moved(data, with("tray", 0.03), "little_");
  EXPECT_NEAR(tray.own, 0.03, 1e-6);
  EXPECT_LT(tray.others, 1e-6);
}

TEST(ObjectRig, LetsABoneHaveSeveralJointsAndOthersFollow) {
  const ModelData data = rigged(
      "joints:\n"
      "  - {name: pan, bone: index_1, axis: [0, 0, 1], bounds_deg: [-90, 90]}\n"
      "  - {name: tilt, bone: index_1, axis: [1, 0, 0], bounds_deg: [-45, 45], rest_deg: 5}\n"
      "  - {name: other, bone: little_1, axis: [0, 0, 1], mimic: pan, multiplier: -1}\n");
  EXPECT_EQ(data.parameters.size(), 9U);
  EXPECT_NEAR(data.parameters[8].rest, 5 * kDegree, 1e-12);
  EXPECT_GT(moved(data, {0, 0, 0, 1, 0, 0, 0, 0.5, 5 * kDegree}, "little_").own, 0.001);
}

TEST(ObjectRig, IsRefusedIfItDoesNotFit) {
  EXPECT_THAT(
      message("joints: [{name: lid, bone: indx_1, axis: [1, 0, 0], bounds_deg: [0, 1]}]"),
      HasSubstr("sticks.yaml: joint 'lid' moves the bone 'indx_1', which the mesh file does "
                "not have; did you mean 'index_1'?; its bones are: "));
  EXPECT_THAT(message("joints: [{name: lid, bone: index_1, axis: [1, 0, 0]}]"),
              HasSubstr("joint 'lid' has 0 numbers in bounds_deg, expected the lowest and the "
                        "highest value"));
  EXPECT_THAT(message("joints: [{name: lid, bone: index_1, type: prismatic, axis: [1, 0, 0], "
                      "bounds_deg: [0, 1]}]"),
              HasSubstr("joint 'lid' slides, but has bounds_deg; give bounds_mm instead"));
  EXPECT_THAT(message("joints: [{name: lid, bone: index_1, type: continuous, axis: [1, 0, 0], "
                      "bounds_deg: [0, 1]}]"),
              HasSubstr("joint 'lid' has 2 numbers in bounds_deg, expected none"));
  EXPECT_THAT(message("joints: [{name: lid, bone: index_1, bounds_deg: [0, 1]}]"),
              HasSubstr("axis"));
}

TEST(ObjectRig, NeedsAMeshWithBones) {
  ImportedMesh rigid = test::stick_hand();
  rigid.bones.clear();
  EXPECT_THAT(test::message_of<DataError>([&] { rig_object(rigid, {}, "sticks.yaml"); }),
              HasSubstr("write `type: rigid_mesh`"));
}

}  // namespace
}  // namespace hypotrack::articulated
