#include "output/true_landmarks.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hypotrack
