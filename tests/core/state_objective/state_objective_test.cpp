#include <gtest/gtest.h>

#include <random>

#include "cost/cost.hpp"
#include "device.hpp"
#include "hypotrack/gpu/device_cost.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "test_models.hpp"
#include "track/search/search_space.hpp"
#include "weighted_sum.hpp"

namespace hypotrack {
namespace {

constexpr double kTolerance = 1e-12;
constexpr Eigen::Index kStates = 100;

class WeightedSumObjective final : public Objective {
 public:
  explicit WeightedSumObjective(double factor) : term_{factor} {}

 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    return term_.cost(hypothesis.state.data(), static_cast<int>(hypothesis.state.size()));
  }
  std::unique_ptr<cuda::DeviceObjective> do_on_device() const override {
    return test::on_device(term_);
  }

  test::WeightedSum term_;
};

class StateObjective : public ::testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_DEVICE(); }

  std::unique_ptr<Cost> cost_on(Backend backend) const {
    std::vector<ObjectiveTerm> terms;
    terms.push_back({.weight = 2, .objective = std::make_shared<WeightedSumObjective>(1.0)});
    terms.push_back({.weight = -0.5, .objective = std::make_shared<WeightedSumObjective>(0.1)});
    return make_cost(scene_, terms, {.backend = backend});
  }
  Observation observation() const {
    Observation result;
    result.scene = &scene_;
    result.start = scene_.rest_state();
    return result;
  }
  Eigen::MatrixXd states() const {
    std::mt19937_64 random(7);
    Eigen::MatrixXd result(scene_.dimension(), kStates);
    for (auto state : result.colwise()) state = test::random_state(scene_, random);
    return result;
  }

  const Scene scene_{{{"hand", std::make_shared<Model>(test::make_test_hand())},
                      {"box", std::make_shared<Model>(test::make_test_box())}}};
};

Eigen::VectorXd costs_of(Cost& cost, const Eigen::MatrixXd& states) {
  Eigen::VectorXd costs(states.cols());
  cost.evaluate(states, costs);
  return costs;
}

Eigen::VectorXd costs_of(cuda::DeviceCost& device, const Eigen::MatrixXd& points) {
  const auto size = static_cast<std::size_t>(points.size());
  cuda::DeviceBuffer<double> on_device(size), costs_on_device(static_cast<std::size_t>(kStates));
  cuda::check(
      cudaMemcpy(on_device.data(), points.data(), size * sizeof(double), cudaMemcpyHostToDevice),
      "uploading points");
  cuda::check(cudaDeviceSynchronize(), "uploading points");
  device.reserve(points.cols());
  device.enqueue(on_device.data(), points.cols(), costs_on_device.data());
  cuda::check(cudaStreamSynchronize(cuda::native(device.stream())), "evaluating");
  Eigen::VectorXd costs(points.cols());
  cuda::check(cudaMemcpy(costs.data(), costs_on_device.data(), costs_on_device.size() * 8,
                         cudaMemcpyDeviceToHost),
              "downloading costs");
  return costs;
}

TEST_F(StateObjective, WeightedTermsAddUpToTheCostsOfTheCpu) {
  const auto cpu = cost_on(Backend::cpu), device = cost_on(Backend::cuda);
  const Observation frame = observation();
  cpu->prepare(frame);
  device->prepare(frame);
  const Eigen::MatrixXd states = this->states();
  EXPECT_TRUE(costs_of(*device, states).isApprox(costs_of(*cpu, states), kTolerance));
}

TEST_F(StateObjective, SearchPointsAreDecodedAsOnTheCpu) {
  const auto cpu = cost_on(Backend::cpu), device = cost_on(Backend::cuda);
  const Observation frame = observation();
  cpu->prepare(frame);
  device->prepare(frame);
  const Eigen::VectorXd prior = states().col(0);
  for (const auto rotation_as : {RotationCoordinates::quaternion, RotationCoordinates::tangent}) {
    SearchSettings settings;
    settings.rotation_as = rotation_as;
    const SearchSpace space(scene_, settings);
    std::srand(3);
    const Eigen::MatrixXd points = Eigen::MatrixXd::Random(space.dimension(), kStates);
    cuda::DeviceCost* device_cost = device->device(space.rotation_vectors() ? &prior : nullptr);
    ASSERT_NE(device_cost, nullptr);
    EXPECT_TRUE(costs_of(*device_cost, points)
                    .isApprox(costs_of(*cpu, space.states(points, prior)), kTolerance))
        << enum_names(rotation_as)[static_cast<std::size_t>(rotation_as)];
  }
}

TEST_F(StateObjective, ScoringDrawnHypothesesLeavesTheOthersAlone) {
  const test::WeightedSum term{1.0};
  const auto objective = test::on_device(term);
  const Eigen::Index dimension = scene_.dimension();
  cuda::DeviceBuffer<double> costs(kStates), points(static_cast<std::size_t>(dimension * kStates));
  cuda::check(cudaMemset(points.data(), 0, points.size() * sizeof(double)), "clearing points");
  const Eigen::VectorXd before = Eigen::VectorXd::Constant(kStates, 5.0);
  cuda::check(cudaMemcpy(costs.data(), before.data(), kStates * 8, cudaMemcpyHostToDevice),
              "uploading costs");
  cuda::SceneLayout layout{};  // an empty scene: every cost is 0
  layout.dimension = 0;
  const cuda::BatchLayout batch{points.data(), kStates, costs.data(), 1.0, nullptr, false};
  objective->reserve(layout, {}, kStates);
  objective->enqueue_drawn(layout, batch, {.texture = 0, .first = 10, .count = 20}, {});
  Eigen::VectorXd after(kStates);
  cuda::check(cudaMemcpy(after.data(), costs.data(), kStates * 8, cudaMemcpyDeviceToHost),
              "downloading costs");
  Eigen::VectorXd expected = before;
  expected.segment(10, 20).setZero();
  EXPECT_EQ(after, expected);
}

}  // namespace
}  // namespace hypotrack
