#include "plausible_motion.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "jacobian_contract.hpp"
#include "test_models.hpp"

namespace hypotrack::plausible_motion {
namespace {

constexpr double kOff = 1e6 * kDegree;  // so wide that the term costs next to nothing
const PlausibleMotionParams kNothing{.motion_sigma = kOff,
                                     .coupling_sigma = kOff,
                                     .curl_sigma = kOff,
                                     .neighbor_sigma = kOff,
                                     .abduction_sigma = kOff,
                                     .thumb_sigma = kOff};

std::shared_ptr<const Model> make_model(const std::string& yaml) {
  PluginLoader plugins;
  return plugins.make<Model>(ConfigNode::parse(yaml, "scene.yaml"));
}

/// A scene with a frame whose search starts at a state.
class PlausibleMotionTest : public testing::Test {
 protected:
  double cost(const PlausibleMotionParams& params, const Eigen::VectorXd& state) const {
    PlausibleMotion objective(params, scene_);
    const Observation observation = frame();
    objective.prepare(observation);
    return objective.cost({{state.data(), static_cast<std::size_t>(state.size())}, {}});
  }

  Observation frame() const {
    Observation observation;
    observation.scene = &scene_;
    observation.start = start_;
    observation.context.no_motion_prior = no_motion_prior_;
    return observation;
  }

  double& angle(Eigen::VectorXd& state, const std::string& name) const {
    for (std::size_t i = 0; i < scene_.parameters().size(); ++i) {
      if (scene_.parameters()[i].name == name) return state[static_cast<Eigen::Index>(i)];
    }
    throw std::out_of_range(name);
  }

  const Scene scene_{{{"right", make_model("type: hand\n")},
                      {"box", make_model("type: rigid_box\n")},
                      {"left", make_model("type: mirrored_hand\n")}}};
  Eigen::VectorXd start_ = scene_.rest_state();
  bool no_motion_prior_ = false;
};

TEST_F(PlausibleMotionTest, OfNoMotionCoupledFingersAndARelaxedThumbIsNothing) {
  for (const char* hand : {"right.", "left."}) {
    for (const char* finger : {"index", "middle", "ring", "little"}) {
      const std::string name = std::string(hand) + finger;
      angle(start_, name + "_flexion_1") = 0.6;
      angle(start_, name + "_flexion_2") = 0.6;
      angle(start_, name + "_flexion_3") = 0.4;
    }
    const std::string thumb = std::string(hand) + "thumb";
    angle(start_, thumb + "_abduction") = 30 * kDegree;
    angle(start_, thumb + "_flexion_1") = 5 * kDegree;
    angle(start_, thumb + "_flexion_2") = 12 * kDegree;
    angle(start_, thumb + "_flexion_3") = 10 * kDegree;
  }
  EXPECT_NEAR(cost({}, start_), 0, 1e-12);
}

TEST_F(PlausibleMotionTest, CostsOneForEveryJointThatTurnsBySigma) {
  PlausibleMotionParams params = kNothing;
  params.motion_sigma = 0.2;
  Eigen::VectorXd state = start_;
  angle(state, "right.index_flexion_1") += 0.2;
  EXPECT_NEAR(cost(params, state), 1, 1e-6);
  angle(state, "left.thumb_abduction") -= 0.4;
  EXPECT_NEAR(cost(params, state), 5, 1e-6);
}

TEST_F(PlausibleMotionTest, ForgetsTheFramesBefore) {
  PlausibleMotion seen({}, scene_);
  for (const bool no_motion_prior : {false, true, false}) {
    angle(start_, "right.index_flexion_1") += 0.3;
    no_motion_prior_ = no_motion_prior;
    const Observation observation = frame();
    seen.prepare(observation);
    const Eigen::VectorXd rest = scene_.rest_state();
    EXPECT_EQ(seen.cost({{rest.data(), static_cast<std::size_t>(rest.size())}, {}}),
              cost({}, rest));
  }
}

TEST_F(PlausibleMotionTest, WithoutMotionPriorHoldsNothingToWhereTheSearchStarted) {
  no_motion_prior_ = true;
  const Eigen::VectorXd relaxed = start_;
  const double before = cost({}, relaxed);
  for (const char* joint : {"index_flexion_1", "index_flexion_2", "thumb_abduction"})
    angle(start_, std::string("right.") + joint) += 0.5;
  EXPECT_EQ(cost({}, relaxed), before);
}

TEST_F(PlausibleMotionTest, LeavesPositionsAndRotationsFree) {
  Eigen::VectorXd state = start_;
  std::mt19937_64 random(1);
  const Eigen::VectorXd other = test::random_state(scene_, random);
  for (const Scene::Item& item : scene_.items()) {
    state.segment<7>(item.offset) = other.segment<7>(item.offset);
  }
  EXPECT_EQ(cost({}, state), cost({}, start_));
}

TEST_F(PlausibleMotionTest, CostsOneForEveryFingerThatIsUncoupledBySigma) {
  PlausibleMotionParams params = kNothing;
  params.coupling_sigma = 0.1;
  params.coupling = 0.5;
  Eigen::VectorXd state = start_;
  for (std::size_t i = 0; i < scene_.parameters().size(); ++i) {
    if (scene_.parameters()[i].kind == ParameterKind::angle)
      state[static_cast<Eigen::Index>(i)] = 0;
  }
  EXPECT_NEAR(cost(params, state), 0, 1e-6);
  angle(state, "right.ring_flexion_2") = 0.8;
  angle(state, "right.ring_flexion_3") = 0.4;
  EXPECT_NEAR(cost(params, state), 0, 1e-6);
  angle(state, "right.ring_flexion_3") = 0.3;
  EXPECT_NEAR(cost(params, state), 1, 1e-6);
  angle(state, "left.thumb_flexion_3") = 0.5;
  EXPECT_NEAR(cost(params, state), 1, 1e-6) << "a thumb's joints are free";
}

TEST_F(PlausibleMotionTest, CostsOneForEveryFingerThatIsCurledBySigmaMoreThanItsKnuckle) {
  PlausibleMotionParams params = kNothing;
  params.curl_sigma = 0.2;
  params.curl = 1.5;
  Eigen::VectorXd state = start_;
  for (std::size_t i = 0; i < scene_.parameters().size(); ++i) {
    if (scene_.parameters()[i].kind == ParameterKind::angle)
      state[static_cast<Eigen::Index>(i)] = 0;
  }
  angle(state, "left.index_flexion_1") = 0.4;
  angle(state, "left.index_flexion_2") = 0.6;
  EXPECT_NEAR(cost(params, state), 0, 1e-6);
  angle(state, "left.index_flexion_2") = 0.8;
  EXPECT_NEAR(cost(params, state), 1, 1e-6);
  angle(state, "right.thumb_flexion_2") = 0.5;
  EXPECT_NEAR(cost(params, state), 1, 1e-6) << "a thumb's joints are free";
}

TEST_F(PlausibleMotionTest, CostsOneForEveryTwoFingersSideBySideWhoseKnucklesDifferBySigma) {
  PlausibleMotionParams params = kNothing;
  params.neighbor_sigma = 0.2;
  Eigen::VectorXd state = start_;
  for (const char* finger : {"index", "middle", "ring", "little"}) {
    angle(state, std::string("right.") + finger + "_flexion_1") = 0.5;
    angle(state, std::string("left.") + finger + "_flexion_1") = 0.9;
  }
  EXPECT_NEAR(cost(params, state), 0, 1e-6);
  angle(state, "left.little_flexion_1") = 0.7;
  EXPECT_NEAR(cost(params, state), 1, 1e-6);
  angle(state, "right.middle_flexion_1") = 0.1;
  EXPECT_NEAR(cost(params, state), 1 + 4 + 4, 1e-6) << "it has two neighbours";
  angle(state, "right.thumb_flexion_1") += 0.4;
  EXPECT_NEAR(cost(params, state), 9, 1e-6) << "the thumb is nobody's";
}

TEST_F(PlausibleMotionTest, CostsOneForEveryFingerThatStraysSidewaysBySigma) {
  PlausibleMotionParams params = kNothing;
  params.abduction_sigma = 0.1;
  const double straight = cost(params, start_);
  Eigen::VectorXd state = start_;
  angle(state, "right.little_abduction") = -0.1;
  angle(state, "left.index_abduction") = 0.1;
  EXPECT_NEAR(cost(params, state) - straight, 2, 1e-6);
  angle(state, "right.thumb_abduction") = 0.7;
  EXPECT_NEAR(cost(params, state) - straight, 2, 1e-6) << "a thumb's is its own";
}

TEST_F(PlausibleMotionTest, CostsOneForEveryJointOfAThumbThatIsOffARelaxedOneBySigma) {
  PlausibleMotionParams params = kNothing;
  params.thumb_sigma = 0.2;
  Eigen::VectorXd state = start_;
  for (const char* hand : {"right.", "left."}) {
    const std::string thumb = std::string(hand) + "thumb";
    angle(state, thumb + "_abduction") = 30 * kDegree;
    angle(state, thumb + "_flexion_1") = 5 * kDegree;
    angle(state, thumb + "_flexion_2") = 12 * kDegree;
    angle(state, thumb + "_flexion_3") = 10 * kDegree;
  }
  EXPECT_NEAR(cost(params, state), 0, 1e-6);
  angle(state, "left.thumb_abduction") += 0.2;
  EXPECT_NEAR(cost(params, state), 1, 1e-6);
  angle(state, "right.thumb_flexion_3") -= 0.4;
  EXPECT_NEAR(cost(params, state), 5, 1e-6);
  angle(state, "right.index_flexion_1") += 0.4;
  EXPECT_NEAR(cost(params, state), 5, 1e-6) << "fingers are free";
}

TEST_F(PlausibleMotionTest, IsTheSumOfItsSquaredResiduals) {
  PlausibleMotion objective({}, scene_);
  Observation observation;
  observation.start = start_;
  objective.prepare(observation);
  const ResidualTerm* term = objective.residual_term();
  ASSERT_NE(term, nullptr);
  ASSERT_EQ(term->residual_count(), 2 * (20 + 8 + 3 + 4 + 4));
  std::vector<float> residuals(static_cast<std::size_t>(term->residual_count()));
  std::mt19937_64 random(9);
  for (int round = 0; round < 20; ++round) {
    const Eigen::VectorXd state = test::random_state(scene_, random);
    const RenderedHypothesis hypothesis{{state.data(), static_cast<std::size_t>(state.size())}, {}};
    term->write_residuals(hypothesis, residuals);
    double sum = 0;
    for (const float r : residuals) sum += double{r} * r;
    EXPECT_NEAR(sum, objective.cost(hypothesis), 1e-5 * sum);
  }
}

TEST_F(PlausibleMotionTest, FollowsTheStartOfEveryFrame) {
  PlausibleMotionParams params = kNothing;
  params.motion_sigma = 0.2;
  PlausibleMotion objective(params, scene_);
  Observation first, second;
  first.start = start_;
  second.start = start_;
  angle(second.start, "left.index_flexion_1") += 0.3;
  const auto cost_of = [&](const Eigen::VectorXd& state) {
    return objective.cost({{state.data(), static_cast<std::size_t>(state.size())}, {}});
  };
  objective.prepare(first);
  EXPECT_NEAR(cost_of(first.start), 0, 1e-6);
  EXPECT_GT(cost_of(second.start), 1);
  objective.prepare(second);
  EXPECT_GT(cost_of(first.start), 1);
  EXPECT_NEAR(cost_of(second.start), 0, 1e-6);
}

TEST_F(PlausibleMotionTest, HasTheJacobianOfItsResiduals) {
  PlausibleMotion objective({}, scene_);
  Observation observation;
  observation.scene = &scene_;
  observation.start = start_;
  std::mt19937_64 random(4);
  Eigen::VectorXd state = hypotrack::test::random_state(scene_, random);
  scene_.normalize(state);
  for (const bool no_motion_prior : {false, true}) {
    observation.context.no_motion_prior = no_motion_prior;
    objective.prepare(observation);
    EXPECT_NO_THROW(contract::check_jacobian(
        objective, scene_, {{state.data(), static_cast<std::size_t>(state.size())}, {}}, "state"));
  }
}

}  // namespace
}  // namespace hypotrack::plausible_motion
