// Hypotheses that OpenGL draws and CUDA scores against those that the CPU draws and scores.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "cost/cost.hpp"
#include "cost/draw/hypothesis_renderer.hpp"
#include "device.hpp"
#include "hypotrack/api/error.hpp"
#include "observations.hpp"
#include "probes.hpp"
#include "test_models.hpp"

namespace hypotrack::test {
namespace {

// What test_egl_hypotheses.cpp allows: pixels per tile that an outline passes so closely that
// rounding decides, and the share of pixels whose depth moves with the rounding of corners.
constexpr double kEdgePixels = 8;
constexpr double kSteepShare = 0.005;
// The largest that a pixel adds: covered in its view, and in the two directions of stereo as itself
// and as what the other view's pixel sees.
constexpr double kCoveredWeight = 0.7, kSeenWeight = 1.5;
constexpr double kPixelSum = 2.5 * kCoveredWeight + 2 * 1.6 * kSeenWeight;
constexpr double kEdgeSum = 2 * kEdgePixels * kPixelSum;

Scene two_hands_scene() {
  return Scene({{"right", std::make_shared<const Model>(make_test_hand())},
                {"left", std::make_shared<const Model>(mirrored(make_test_hand()))}});
}

Eigen::MatrixXd random_states(const Scene& scene, int count, unsigned seed = 3) {
  std::mt19937_64 random(seed);
  Eigen::MatrixXd states(scene.dimension(), count);
  for (int i = 0; i < count; ++i) states.col(i) = random_state(scene, random);
  return states;
}

std::unique_ptr<Cost> cost_on(const Scene& scene, Backend backend) {
  EvaluateSettings settings;
  settings.backend = backend;
  std::vector<ObjectiveTerm> terms{{kCoveredWeight, covered_probe(), "covered"},
                                   {0, seen_probe(false), "unasked"},
                                   {kSeenWeight, seen_probe(true), "seen"}};
  return make_cost(scene, std::move(terms), settings);
}

Eigen::VectorXd costs_of(Cost& cost, const Eigen::MatrixXd& states) {
  Eigen::VectorXd costs = Eigen::VectorXd::Constant(states.cols(), NAN);
  cost.evaluate(states, costs);
  return costs;
}

void expect_cpu_costs(Cost& cost, const Scene& scene, const Observation& observation,
                      const Eigen::MatrixXd& states) {
  const auto cpu = cost_on(scene, Backend::cpu);
  cpu->prepare(observation);
  const Eigen::VectorXd expected = costs_of(*cpu, states), costs = costs_of(cost, states);
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    EXPECT_NEAR(costs[i], expected[i], kEdgeSum + kSteepShare * std::abs(expected[i]))
        << "hypothesis " << i;
  }
  EXPECT_LE((costs - expected).cwiseAbs().mean(), kEdgeSum / kEdgePixels)
      << "more than one pixel per tile";
  const double range = expected.maxCoeff() - expected.minCoeff();
  EXPECT_GT(range, 4 * kEdgeSum) << "these hypotheses could be mixed up without notice";
}

/// Skips where OpenGL and CUDA have no GPU in common.
class EglInterop : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_DEVICE();
    try {
      const std::string backend = cost_on(hand_scene_, Backend::egl)->backend();
      if (backend.find("does not draw on a GPU that CUDA sees") != std::string::npos) {
        GTEST_SKIP() << backend;
      }
      ASSERT_THAT(backend, testing::HasSubstr("CUDA interop"));
    } catch (const DeviceError& no_opengl) {
      GTEST_SKIP() << no_opengl.what();
    }
  }

  Scene hand_scene_ = hand_scene();
};

TEST_F(EglInterop, GivesTheCostsOfTheCpuForRectifiedViews) {
  for (const Scene& scene : {hand_scene(), hand_and_box_scene(), two_hands_scene()}) {
    SCOPED_TRACE(scene.dimension());
    const Observation observation = rectified_pair(scene);
    const auto egl = cost_on(scene, Backend::egl);
    egl->prepare(observation);
    expect_cpu_costs(*egl, scene, observation, random_states(scene, 16));
  }
}

TEST_F(EglInterop, GivesTheCostsOfTheCpuForAnyTwoViews) {
  for (const Scene& scene : {hand_scene(), hand_and_box_scene(), two_hands_scene()}) {
    SCOPED_TRACE(scene.dimension());
    const Observation observation = general_pair(scene);
    const auto egl = cost_on(scene, Backend::egl);
    egl->prepare(observation);
    expect_cpu_costs(*egl, scene, observation, random_states(scene, 16));
  }
}

TEST_F(EglInterop, TakesMoreHypothesesThanATextureHasLayers) {
  const Observation observation = rectified_pair(hand_scene_, 64);
  const auto egl = cost_on(hand_scene_, Backend::egl);
  egl->prepare(observation);
  // OpenGL promises 256 layers, NVIDIA's has 2048.
  expect_cpu_costs(*egl, hand_scene_, observation, random_states(hand_scene_, 2500));
}

TEST_F(EglInterop, TakesBatchesOfChangingSize) {
  const Observation observation = rectified_pair(hand_scene_);
  const auto egl = cost_on(hand_scene_, Backend::egl);
  egl->prepare(observation);
  const Eigen::MatrixXd states = random_states(hand_scene_, 40);
  const Eigen::VectorXd all = costs_of(*egl, states);
  EXPECT_EQ(costs_of(*egl, states.leftCols(0)).size(), 0);
  for (const int count : {1, 7, 40, 3}) {
    EXPECT_EQ(costs_of(*egl, states.leftCols(count)), all.head(count)) << count;
  }
}

TEST_F(EglInterop, FollowsTheFrameToOtherTiles) {
  const auto egl = cost_on(hand_scene_, Backend::egl);
  const Eigen::MatrixXd states = random_states(hand_scene_, 6);
  for (const int size : {128, 96, 200, 128}) {
    SCOPED_TRACE(size);
    const Observation observation = rectified_pair(hand_scene_, size);
    egl->prepare(observation);
    expect_cpu_costs(*egl, hand_scene_, observation, states);
  }
  const Observation general = general_pair(hand_scene_);
  egl->prepare(general);
  expect_cpu_costs(*egl, hand_scene_, general, states);
}

TEST_F(EglInterop, LetsSeveralCostsLiveAtOnce) {
  const Scene other = hand_and_box_scene();
  const Observation first_frame = rectified_pair(hand_scene_), second_frame = general_pair(other);
  auto first = cost_on(hand_scene_, Backend::egl);
  const auto second = cost_on(other, Backend::egl);
  first->prepare(first_frame);
  second->prepare(second_frame);
  const Eigen::MatrixXd states = random_states(other, 5);
  const Eigen::VectorXd alone = costs_of(*second, states);
  expect_cpu_costs(*first, hand_scene_, first_frame, random_states(hand_scene_, 5));
  EXPECT_EQ(costs_of(*second, states), alone);
  first.reset();
  EXPECT_EQ(costs_of(*second, states), alone);
}

TEST_F(EglInterop, WorksFromAnyThread) {
  const Observation observation = rectified_pair(hand_scene_);
  const auto egl = cost_on(hand_scene_, Backend::egl);
  egl->prepare(observation);
  const Eigen::MatrixXd states = random_states(hand_scene_, 4);
  const Eigen::VectorXd here = costs_of(*egl, states);
  Eigen::VectorXd there;
  std::thread([&] { there = costs_of(*egl, states); }).join();
  EXPECT_EQ(here, there);
}

TEST_F(EglInterop, RefusesMoreViewsThanTheDeviceTakesAndGoesOn) {
  const auto egl = cost_on(hand_scene_, Backend::egl);
  Observation many = rectified_pair(hand_scene_);
  many.rectified = false;
  many.views.resize(5, many.views[0]);
  EXPECT_THROW(egl->prepare(many), DeviceError);
  const Observation observation = rectified_pair(hand_scene_);
  egl->prepare(observation);
  expect_cpu_costs(*egl, hand_scene_, observation, random_states(hand_scene_, 3));
}

}  // namespace
}  // namespace hypotrack::test
