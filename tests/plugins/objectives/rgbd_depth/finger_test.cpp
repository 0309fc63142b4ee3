#include <gtest/gtest.h>

#include "depth_scene.hpp"
#include "finger_pair.hpp"
#include "rgbd_depth.hpp"
#include "test_models.hpp"

namespace hypotrack::rgbd_depth {
namespace {

std::shared_ptr<const Model> hand() {
  return std::make_shared<const Model>(test::make_test_hand());
}

void set(const Scene& scene, Eigen::VectorXd& state, const std::string& name, double degrees) {
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    if (scene.parameters()[static_cast<std::size_t>(i)].name == name) {
      state[i] = degrees * kDegree;
      return;
    }
  }
  FAIL() << "no parameter " << name;
}

double crossing(const Scene& scene, const Eigen::VectorXd& state) {
  const std::vector<FingerPair> pairs = adjacent_fingers(scene);
  return finger_crossing(pairs.data(), static_cast<int>(pairs.size()), state.data());
}

TEST(FingerCrossing, OfSpreadOrParallelFingersIsZero) {
  const Scene scene({{"hand", hand()}});
  Eigen::VectorXd state = scene.rest_state();
  EXPECT_EQ(adjacent_fingers(scene).size(), 3u);
  EXPECT_EQ(crossing(scene, state), 0);
  set(scene, state, "hand.index_abduction", 15);
  set(scene, state, "hand.ring_abduction", -10);
  set(scene, state, "hand.little_abduction", -15);
  EXPECT_EQ(crossing(scene, state), 0);
}

TEST(FingerCrossing, IsTheSumOfNegativeDifferencesOfNeighbours) {
  const Scene scene({{"hand", hand()}});
  Eigen::VectorXd state = scene.rest_state();
  set(scene, state, "hand.index_abduction", -5);   // 5 degrees into the middle finger
  set(scene, state, "hand.ring_abduction", -10);   // away from it
  set(scene, state, "hand.little_abduction", -3);  // 7 into the ring finger
  EXPECT_NEAR(crossing(scene, state), 12 * kDegree, 1e-12);
  set(scene, state, "hand.middle_abduction", -15);  // crosses the ring finger, frees the index
  EXPECT_NEAR(crossing(scene, state), (5 + 7) * kDegree, 1e-12);
}

TEST(FingerCrossing, LeavesTheThumbOut) {
  const Scene scene({{"hand", hand()}});
  Eigen::VectorXd state = scene.rest_state();
  for (const double degrees : {-17, 17}) {
    set(scene, state, "hand.thumb_abduction", degrees);
    EXPECT_EQ(crossing(scene, state), 0);
  }
}

TEST(FingerCrossing, AddsUpOverHandsAndSkipsWhatHasNoFingers) {
  const auto box = std::make_shared<const Model>(test::make_test_box());
  const Scene scene({{"right", hand()}, {"box", box}, {"left", hand()}});
  Eigen::VectorXd state = scene.rest_state();
  EXPECT_EQ(adjacent_fingers(scene).size(), 6u);
  set(scene, state, "right.index_abduction", -5);
  set(scene, state, "left.little_abduction", 4);
  EXPECT_NEAR(crossing(scene, state), 9 * kDegree, 1e-12);
  EXPECT_TRUE(adjacent_fingers(box_scene()).empty());
}

TEST(FingerCrossing, NeedsBothFingersOfAPair) {
  ModelData data = test::make_test_hand();
  for (Parameter& parameter : data.parameters) {
    if (parameter.name == "middle_abduction") parameter.name = "middle_spread";
  }
  const Scene scene({{"hand", std::make_shared<const Model>(std::move(data))}});
  EXPECT_EQ(adjacent_fingers(scene).size(), 1u) << "ring and little finger";
}

TEST(FingerCrossing, AddsLambdaKPerRadianToTheCost) {
  const Scene scene({{"hand", hand()}});
  Observation observation = blank_observation(4);
  observation.scene = &scene;
  observation.start = scene.rest_state();
  Eigen::VectorXd state = scene.rest_state();
  set(scene, state, "hand.index_abduction", -6);
  const Drawn nothing({Grid(16)});
  for (const double lambda_k : {0.0, 10.0, 25.0}) {
    Params params;
    params.lambda_k = lambda_k;
    RgbdDepth objective(params);
    objective.prepare(observation);
    const double cost = objective.cost(
        {{state.data(), static_cast<std::size_t>(state.size())}, nothing.hypothesis().views});
    EXPECT_NEAR(cost, 20 + lambda_k * 6 * kDegree, 1e-9);
  }
}

}  // namespace
}  // namespace hypotrack::rgbd_depth
