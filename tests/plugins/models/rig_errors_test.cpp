#include <gmock/gmock.h>

#include "hypotrack/api/error.hpp"
#include "rigged_fixture.hpp"

namespace hypotrack::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string error_after(const std::string& from, const std::string& to) {
  return rig_error(replaced(stick_rig(), from, to));
}

TEST(RigErrors, UnknownFileBoneSuggestsTheNearest) {
  EXPECT_THAT(error_after("joint: index_2", "joint: indexx_2"),
              AllOf(HasSubstr("stick.yaml: bone 'index_2', `weights`, names the bone 'indexx_2', "
                              "which the mesh file does not have"),
                    HasSubstr("did you mean 'index_2'?")));
  EXPECT_THAT(error_after("end: ring_3", "end: rign_3"),
              AllOf(HasSubstr("`end`"), HasSubstr("did you mean 'ring_3'?")));
  EXPECT_THAT(error_after("origin: wrist", "origin: somewhere"),
              AllOf(HasSubstr("`frame: origin` names the bone 'somewhere'"),
                    HasSubstr("there are: wrist, thumb_1")));
}

TEST(RigErrors, UnknownParentSuggestsTheNearest) {
  EXPECT_THAT(error_after("parent: middle_1", "parent: midle_1"),
              AllOf(HasSubstr("bone 'middle_2', `parent`, names the bone 'midle_1', which the rig "
                              "does not have"),
                    HasSubstr("did you mean 'middle_1'?")));
}

TEST(RigErrors, CyclesAndLateParentsAreRefused) {
  EXPECT_THAT(
      error_after("name: index_1, parent: wrist", "name: index_1, parent: index_3"),
      HasSubstr("the parent of bone 'index_1' is 'index_3', which comes later or is itself"));
  EXPECT_THAT(error_after("name: index_1, parent: wrist", "name: index_1, parent: index_1"),
              HasSubstr("without cycles"));
  EXPECT_THAT(error_after("name: index_1, parent: wrist", "name: index_1"),
              HasSubstr("bone 'index_1' has no parent; only the first bone, 'wrist', may be the "
                        "root"));
  EXPECT_THAT(error_after("name: index_2", "name: index_1"),
              HasSubstr("two bones are named 'index_1'"));
}

TEST(RigErrors, EveryAngleMustTurnExactlyOneBone) {
  EXPECT_THAT(error_after("flexion: ring_flexion_2", "flexion_axis: x"),
              HasSubstr("no bone is turned by the parameter 'ring_flexion_2'"));
  EXPECT_THAT(error_after("flexion: ring_flexion_2", "flexion: ring_flexion_1"),
              HasSubstr("the parameter 'ring_flexion_1' turns both 'ring_1' and 'ring_2'"));
  EXPECT_THAT(error_after("flexion: ring_flexion_2", "flexion: ring_flexion_4"),
              AllOf(HasSubstr("bone 'ring_2' names the parameter 'ring_flexion_4'"),
                    HasSubstr("did you mean 'ring_flexion_")));
}

TEST(RigErrors, FileBonesMustGoToExactlyOneBone) {
  EXPECT_THAT(error_after("weights: [ring_3, ring_tip]", "weights: [ring_3]"),
              HasSubstr("no bone of the rig takes the vertices of the file's bones 'ring_tip'"));
  EXPECT_THAT(
      error_after("weights: [ring_3, ring_tip]", "weights: [ring_3, ring_tip, ring_1]"),
      HasSubstr("the weights of the file's bone 'ring_1' go to both 'ring_1' and 'ring_3'"));
}

TEST(RigErrors, FrameMustGiveBothAxesOnceAndNotParallel) {
  EXPECT_THAT(error_after("x: x, y: y", "x: x"), HasSubstr("`frame` must give +X by either"));
  EXPECT_THAT(error_after("x: x, y: y", "x: x, y: y, distal: middle_1"),
              HasSubstr("`frame` must give +X by either"));
  EXPECT_THAT(error_after("x: x, y: y", "x: -y, y: y"), HasSubstr("`frame` gives no axes"));
  EXPECT_THAT(error_after("x: x, y: y", "x: w, y: y"),
              HasSubstr("`frame: x` is 'w': it must be x, -x, y, -y, z or -z"));
  EXPECT_THAT(error_after("x: x, y: y", "radial: [little_1], y: y"),
              HasSubstr("`frame: radial` has 1 entries instead of two bones"));
}

TEST(RigErrors, BonesNeedALengthAndAFlexionAxisAcrossIt) {
  EXPECT_THAT(error_after("end: middle_2", "end: middle_1"),
              HasSubstr("bone 'middle_1' begins and ends in the same place"));
  EXPECT_THAT(error_after("end: middle_2", "end: middle_2, flexion_axis: y"),
              HasSubstr("the flexion axis of bone 'middle_1' runs along the bone"));
  EXPECT_THAT(error_after("end: middle_2", "end: middle_2, flexion_axis: bend"),
              HasSubstr("too little to tell its flexion axis"));
  EXPECT_THAT(error_after("end: middle_2", "end: middle_2, flexion_axis: q"),
              HasSubstr("`flexion_axis` of bone 'middle_1' is 'q'"));
  EXPECT_THAT(error_after("joint: middle_2", "weights: [middle_2]"),
              HasSubstr("bone 'middle_2' needs a `joint`"));
  EXPECT_THAT(error_after("end: middle_2", "end_at: [0, 1]"),
              HasSubstr("`end_at` of bone 'middle_1' has 2 numbers instead of three"));
  EXPECT_THAT(error_after("end: middle_2", "end_at: [0, 999999999999, 0]"),
              HasSubstr("`end_at` of bone 'middle_1' is 1e+12 m from the middle of the mesh"));
}

TEST(RigErrors, ParametersAndLandmarksAreChecked) {
  const std::string rig = stick_rig();
  EXPECT_THAT(rig_error(rig + "parameters: [{name: pinky_flexion_1}]\n"),
              HasSubstr("`parameters` names the parameter 'pinky_flexion_1'"));
  EXPECT_THAT(rig_error(rig + "parameters: [{name: ring_flexion_1, bounds_deg: [50, 20]}]\n"),
              HasSubstr("`bounds_deg` of 'ring_flexion_1' must be a lower and a higher value"));
  EXPECT_THAT(rig_error(rig + "parameters: [{name: ring_flexion_1, rest_deg: 120}]\n"),
              HasSubstr("`rest_deg` of 'ring_flexion_1' is 120, outside its bounds"));
  EXPECT_THAT(rig_error(rig + "landmarks: [{name: ring_tipp, bone: ring_3}]\n"),
              AllOf(HasSubstr("'ring_tipp'"), HasSubstr("did you mean 'ring_tip'?")));
  EXPECT_THAT(rig_error(rig + "landmarks: [{name: ring_tip, bone: ring_4}]\n"),
              HasSubstr("landmark 'ring_tip' names the bone 'ring_4'"));
}

TEST(RigErrors, UnknownKeysAreRefusedWithTheirPlace) {
  EXPECT_THAT(error_after("flexion_axis: x", "flexion_axes: x"),
              AllOf(HasSubstr("stick.yaml:2:1"), HasSubstr("flexion_axis")));
  EXPECT_THAT(rig_error("side: middle\n" + stick_rig()), HasSubstr("stick.yaml:1:"));
}

TEST(RigErrors, MeshAndRigMustHaveBones) {
  EXPECT_THAT(rig_error("frame: {origin: wrist, x: x, y: y}\n"),
              HasSubstr("the rig lists no bones"));
  ImportedMesh rigid = stick_hand();
  rigid.bones.clear();
  try {
    rig_hand(rigid, parse_rig(stick_rig()), "stick.yaml");
    FAIL() << "a mesh without bones was rigged";
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the mesh has no bones"));
  }
}

}  // namespace
}  // namespace hypotrack::test
