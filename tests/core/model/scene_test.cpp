#include "hypotrack/api/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

template <class F>
std::string config_error(F&& f) {
  try {
    f();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Scene, PutsTheParametersOfItsModelsOneAfterTheOther) {
  const Scene scene = test::make_hand_and_box();
  EXPECT_EQ(scene.dimension(), 34);
  EXPECT_EQ(scene.items()[0].offset, 0);
  EXPECT_EQ(scene.items()[1].offset, 27);
  EXPECT_EQ(scene.parameters()[7].name, "hand.thumb_abduction");
  EXPECT_EQ(scene.parameters()[30].name, "box.rotation_w");
  EXPECT_EQ(scene.landmark_names().size(), 24u);
  EXPECT_EQ(scene.landmark_names()[0], "hand.wrist");
  EXPECT_EQ(scene.landmark_names()[21], "box.center");
}

TEST(Scene, CutsTheStateIntoModels) {
  const Scene scene = test::make_hand_and_box();
  const Eigen::VectorXd state = Eigen::VectorXd::LinSpaced(34, 0, 33);
  const auto part = scene.part(scene.items()[1], state);
  EXPECT_EQ(part.size(), 7u);
  EXPECT_EQ(part[0], 27);
  EXPECT_EQ(part.data(), state.data() + 27);
}

TEST(Scene, RestsWhereEveryParameterRests) {
  const Scene scene = test::make_hand_and_box();
  const Eigen::VectorXd rest = scene.rest_state();
  EXPECT_EQ(rest[3], 1);
  EXPECT_EQ(rest[30], 1);
  EXPECT_EQ(rest[8], 0.1);
  scene.check(rest, "rest");
}

TEST(Scene, PlacesTheLandmarksOfEveryModel) {
  const Scene scene = test::make_hand_and_box();
  Eigen::VectorXd state = scene.rest_state();
  state[27] = 1;  // the box to the right
  const Eigen::Matrix3Xd landmarks = scene.landmarks(state);
  ASSERT_EQ(landmarks.cols(), 24);
  EXPECT_EQ(landmarks.col(21), Eigen::Vector3d(1, 0, 0));
  EXPECT_TRUE(landmarks.col(22).isApprox(Eigen::Vector3d(1, 0, 0.06), 1e-6));  // the longest axis
  EXPECT_TRUE(landmarks.col(23).isApprox(Eigen::Vector3d(1.03, 0, 0), 1e-6));
  EXPECT_EQ(landmarks.leftCols(21),
            posed_landmarks(*scene.items()[0].model, scene.part(scene.items()[0], state)));
}

TEST(Scene, NormalizesEveryQuaternionAndNothingElse) {
  const Scene scene = test::make_hand_and_box();
  Eigen::VectorXd state = Eigen::VectorXd::Constant(34, 2);
  state.segment<4>(30) << 0, 0, 0, -3e-200;
  scene.normalize(state);
  EXPECT_TRUE(state.segment<4>(3).isApprox(Eigen::Vector4d::Constant(0.5), 1e-15));
  EXPECT_EQ(state.segment<4>(30), Eigen::Vector4d(0, 0, 0, -1));
  EXPECT_EQ(state.segment<3>(0), Eigen::Vector3d::Constant(2));
  EXPECT_EQ(state.segment<20>(7), (Eigen::VectorXd::Constant(20, 2)));
}

TEST(Scene, NormalizesTheZeroQuaternionToTheIdentity) {
  const Scene scene = test::make_hand_and_box();
  Eigen::VectorXd state = Eigen::VectorXd::Zero(34);
  scene.normalize(state);
  EXPECT_EQ(state.segment<4>(3), Eigen::Vector4d(1, 0, 0, 0));
  EXPECT_EQ(state.segment<4>(30), Eigen::Vector4d(1, 0, 0, 0));
}

TEST(Scene, NormalizingTwiceIsNormalizingOnce) {
  const Scene scene = test::make_hand_and_box();
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::VectorXd once = test::random_state(scene, random);
    Eigen::VectorXd twice = once;
    scene.normalize(twice);
    EXPECT_EQ(twice, once);
  }
}

TEST(Scene, RefusesWhatIsNoScene) {
  const auto box = std::make_shared<const Model>(test::make_test_box());
  EXPECT_EQ(config_error([] { Scene({}); }),
            "scene: there is no model to track; name at least one");
  EXPECT_EQ(config_error([&] {
              Scene({{"a", box}, {"a", box}});
            }),
            "scene: two models are called 'a': give each model a `name` of its own");
  EXPECT_EQ(config_error([&] { Scene({{"a", nullptr}}); }), "scene: there is no model behind 'a'");
}

TEST(Scene, ChecksStates) {
  const Scene scene = test::make_hand_and_box();
  const Eigen::VectorXd rest = scene.rest_state();
  EXPECT_EQ(config_error([&] { scene.check(Eigen::VectorXd::Zero(27), "init"); }),
            "init: the state has 27 numbers, expected 34");

  Eigen::VectorXd state = rest;
  state[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(config_error([&] { scene.check(state, "init"); }),
            "init: hand.position_y is nan, expected a finite number");

  state = rest;
  state[7] = 0.3 + 5e-7;
  scene.check(state, "init");
  state[7] = 0.31;
  EXPECT_EQ(config_error([&] { scene.check(state, "init"); }),
            "init: hand.thumb_abduction is 0.31 rad, expected -0.3 to 0.3");
}

}  // namespace
}  // namespace hypotrack
