#include "output/evaluate/true_landmarks.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "test_models.hpp"

namespace hypotrack {
namespace {

TEST(TrueLandmarks, TheTrueStateGivesTheTrueLandmarks) {
  const Scene scene({{"box", std::make_shared<Model>(test::make_test_box())}});
  Frame frame;
  EXPECT_FALSE(true_landmarks(scene, frame));
  frame.truth = GroundTruth{scene.rest_state(), {}};
  EXPECT_EQ(*true_landmarks(scene, frame), scene.landmarks(scene.rest_state()));
  frame.truth->landmarks = Eigen::Matrix3Xd::Ones(3, 3);
  EXPECT_EQ(*true_landmarks(scene, frame), Eigen::Matrix3Xd::Ones(3, 3));
}

Scene two_boxes() {
  return Scene({{"a", std::make_shared<Model>(test::make_test_box())},
                {"b", std::make_shared<Model>(test::make_test_box())}});
}

TEST(TrueLandmarks, AnAbsentModelHasNone) {
  const Scene scene = two_boxes();
  Frame frame;
  frame.truth = GroundTruth{scene.rest_state(), {}, {false, true}};
  const Eigen::Matrix3Xd landmarks = *true_landmarks(scene, frame);
  EXPECT_EQ(landmarks.leftCols(3), scene.landmarks(scene.rest_state()).leftCols(3));
  EXPECT_TRUE(landmarks.rightCols(3).array().isNaN().all());
}

TEST(TrueLandmarks, AModelIsAbsentIfItsLandmarksAreAndNoneIsKnown) {
  const Scene scene = two_boxes();
  LandmarkRow row{0, 0, scene.landmarks(scene.rest_state())};
  const auto absent = [&] { return absent_models(row, landmark_owners(scene), 2); };
  EXPECT_TRUE(absent().empty());
  row.absent = absent_landmarks(scene, {true, false});
  EXPECT_EQ(row.absent, (std::vector<bool>{true, true, true, false, false, false}));
  EXPECT_TRUE(absent().empty()) << "they are known";
  row.landmarks.leftCols(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(absent(), (std::vector<bool>{true, false}));
}

}  // namespace
}  // namespace hypotrack
