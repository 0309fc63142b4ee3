#include <gmock/gmock.h>

#include "hypotrack/plugin/model.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;

/// A pose and `angles` angles.
ModelData with_angles(int angles) {
  ModelData data;
  data.parameters = pose_parameters();
  for (int i = 0; i < angles; ++i) {
    data.parameters.push_back({"angle_" + std::to_string(i), ParameterKind::angle, -1, 1, 0});
  }
  return data;
}

const std::vector<int> kPose = {0, 1, 2, 3, 4, 5, 6};

TEST(ParameterGroups, AHandHasItsPoseAndFiveFingers) {
  EXPECT_THAT(parameter_groups(test::make_test_hand()),
              ElementsAre(kPose, ElementsAre(7, 8, 9, 10), ElementsAre(11, 12, 13, 14),
                          ElementsAre(15, 16, 17, 18), ElementsAre(19, 20, 21, 22),
                          ElementsAre(23, 24, 25, 26)));
}

TEST(ParameterGroups, ARigidModelHasItsPoseOnly) {
  EXPECT_THAT(parameter_groups(test::make_test_box()), ElementsAre(kPose));
}

TEST(ParameterGroups, AChainEndsWhereTheSkeletonForksAndRigidBonesAreNoJoints) {
  // An arm (two joints with a rigid bone between them) to which two fingers are jointed.
  ModelData data = with_angles(5);
  data.bones = {{"shoulder", -1}, {"sleeve", 0}, {"elbow", 1}, {"palm", 2},
                {"index", 3},     {"tip", 4},    {"thumb", 3}};
  data.motions = {{0, 7}, {2, 8}, {4, 9}, {5, 10}, {6, 11}};
  EXPECT_THAT(parameter_groups(data),
              ElementsAre(kPose, ElementsAre(7, 8), ElementsAre(9, 10), ElementsAre(11)));
}

TEST(ParameterGroups, AParameterOfSeveralLimbsMakesOneOfThem) {
  ModelData data = with_angles(3);
  data.bones = {{"palm", -1}, {"ring", 0}, {"index", 0}, {"little", 0}};
  data.motions = {{1, 7}, {2, 8}, {3, 9}, {1, 9}};
  EXPECT_THAT(parameter_groups(data), ElementsAre(kPose, ElementsAre(7, 9), ElementsAre(8)));
}

TEST(ParameterGroups, AParameterThatTurnsNothingIsAlone) {
  ModelData data = with_angles(2);
  data.bones = {{"palm", -1}, {"index", 0}};
  data.motions = {{1, 8}};
  EXPECT_THAT(parameter_groups(data), ElementsAre(kPose, ElementsAre(7), ElementsAre(8)));
}

TEST(ParameterGroups, JointsThatSlideAreNoPartOfThePose) {
  EXPECT_THAT(parameter_groups(test::make_test_cabinet()),
              ElementsAre(kPose, ElementsAre(7), ElementsAre(8), ElementsAre(9)));
}

}  // namespace
}  // namespace hypotrack
