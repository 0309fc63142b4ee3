#include "pipeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/search.hpp"
#include "limb_search.hpp"
#include "multi_start.hpp"
#include "random_search.hpp"
#include "search_problems.hpp"

namespace hypotrack {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// What a stage was asked.
struct Call {
  SearchRegion region;
  Budget budget;
  std::uint64_t seed = 0;
};

/// Steps from the start by a distance along dimension 0 and evaluates `uses` of its budget at most.
class Stepper final : public Optimizer {
 public:
  Stepper(std::vector<Call>& calls, double step, std::int64_t uses = 1 << 20)
      : calls_(calls), step_(step), uses_(uses) {}
  std::int64_t default_evaluations() const override { return 1; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override {
    calls_.push_back({region, budget, seed});
    BestSoFar best;
    Eigen::VectorXd point = region.start;
    for (std::int64_t i = 0; i < std::min(uses_, budget.evaluations); ++i) {
      Eigen::VectorXd value(1);
      cost.evaluate(point, value);
      best.update(point, value);
      point[0] += step_;
    }
    return best.result();
  }

 private:
  std::vector<Call>& calls_;
  double step_;
  std::int64_t uses_;
};

template <class E>
class Failing final : public Optimizer {
 public:
  explicit Failing(std::string message = "cannot do that") : message_(std::move(message)) {}
  std::int64_t default_evaluations() const override { return 1; }
  OptimizerResult minimize(CostFunction&, const SearchRegion&, const Budget&,
                           std::uint64_t) override {
    throw E(message_);
  }

 private:
  std::string message_;
};

SearchRegion line() {
  return {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, -100),
          Eigen::VectorXd::Constant(1, 100), Eigen::VectorXd::Ones(1)};
}

test::RecordingCost away_from(double target) {
  return {1, [target](const Eigen::VectorXd& x) { return std::abs(x[0] - target); }};
}

class PipelineTest : public ::testing::Test {
 protected:
  void add(std::string name, double step, double share, double spread = 1,
           std::int64_t uses = 1 << 20) {
    stages_.push_back(
        {std::move(name), std::make_unique<Stepper>(calls_, step, uses), share, spread});
  }
  OptimizerResult minimize(CostFunction& cost, const Budget& budget, std::uint64_t seed = 7) {
    return Pipeline(std::move(stages_), 100).minimize(cost, line(), budget, seed);
  }
  std::vector<std::int64_t> budgets() const {
    std::vector<std::int64_t> budgets;
    for (const Call& call : calls_) budgets.push_back(call.budget.evaluations);
    return budgets;
  }

  std::vector<PipelineStage> stages_;
  std::vector<Call> calls_;
};

TEST_F(PipelineTest, EachStageBeginsAtTheBestSoFarWithItsSpread) {
  add("forwards", 1, 1);
  add("backwards", -1, 1, 0.5);
  add("again", 1, 2, 0.25);
  test::RecordingCost cost = away_from(3);
  const OptimizerResult result = minimize(cost, {40});
  EXPECT_EQ(result.point[0], 3);
  EXPECT_EQ(result.evaluations, 40);
  ASSERT_EQ(calls_.size(), 3u);
  EXPECT_EQ(calls_[0].region.start[0], 0);
  EXPECT_EQ(calls_[1].region.start[0], 3);
  EXPECT_EQ(calls_[2].region.start[0], 3);
  EXPECT_EQ(calls_[1].region.spread[0], 0.5);
  EXPECT_EQ(calls_[2].region.spread[0], 0.25) << "of the region's, not of the stage before";
  EXPECT_EQ(calls_[2].region.upper, line().upper);
}

TEST_F(PipelineTest, SharesOfTheBudgetAddUpToAllOfIt) {
  add("a", 0, 3);
  add("b", 0, 2);
  add("c", 0, 2);
  test::RecordingCost cost = away_from(3);
  EXPECT_EQ(minimize(cost, {101}).evaluations, 101);
  EXPECT_THAT(budgets(), ElementsAre(43, 29, 29));
}

TEST_F(PipelineTest, WhatAStageLeavesGoesToThoseAfterIt) {
  add("a", 0, 1, 1, 10);
  add("b", 0, 1);
  add("c", 0, 1);
  test::RecordingCost cost = away_from(3);
  EXPECT_EQ(minimize(cost, {90}).evaluations, 90);
  EXPECT_THAT(budgets(), ElementsAre(30, 40, 40));
}

TEST_F(PipelineTest, StagesWithoutAnEvaluationArePassedOver) {
  add("a", 0, 0.4);
  add("b", 0, 0.6);
  test::RecordingCost cost = away_from(3);
  EXPECT_EQ(minimize(cost, {1}).evaluations, 1);
  EXPECT_THAT(budgets(), ElementsAre(1));
}

TEST_F(PipelineTest, AFallbackIsLeftOutWhereTheBestCostsNoMoreThanUsual) {
  for (const double usual : {2.0, 1.9}) {  // the best of stage a costs 2
    calls_.clear();
    stages_.clear();
    add("a", 1, 1, 1, 2);
    add("b", 1, 1);
    add("c", 1, 1);
    stages_[1].fallback = true;
    test::RecordingCost cost = away_from(3);
    const double infinite = std::numeric_limits<double>::infinity();
    EXPECT_EQ(minimize(cost, {90, infinite, usual}).evaluations, 90);
    const std::vector<std::int64_t> without{30, 88}, with{30, 44, 44};
    EXPECT_EQ(budgets(), usual == 2 ? without : with);
    for (const Call& call : calls_) EXPECT_EQ(call.budget.usual_cost, usual);
  }
}

TEST_F(PipelineTest, WithoutAUsualCostEveryFallbackRuns) {
  add("a", 1, 1);
  add("b", 1, 1);
  stages_[1].fallback = true;
  test::RecordingCost cost = away_from(0);
  minimize(cost, {10});
  EXPECT_THAT(budgets(), ElementsAre(5, 5));
}

/// A pose of two dimensions around a limb of one.
SearchRegion pose_and_limb() {
  SearchRegion region{Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(-100),
                      Eigen::Vector3d::Constant(100), Eigen::Vector3d::Ones()};
  region.groups = {{SearchGroup::Kind::pose, {0, 2}}, {SearchGroup::Kind::limb, {1}}};
  return region;
}

TEST_F(PipelineTest, WhatAStageDoesNotMoveIsHeldWhereItBegins) {
  add("all", 1, 1, 1, 4);
  add("limbs", 0, 1);
  add("poses", 1, 1);
  stages_[1].moves = Moves::limbs;
  stages_[2].moves = Moves::poses;
  test::RecordingCost cost(3, [](const Eigen::VectorXd& x) { return std::abs(x[0] - 3); });
  Pipeline(std::move(stages_), 100).minimize(cost, pose_and_limb(), {60}, 7);
  ASSERT_EQ(calls_.size(), 3u);
  EXPECT_EQ(calls_[0].region.lower, Eigen::Vector3d(-100, -100, -100));
  EXPECT_EQ(calls_[0].region.upper, Eigen::Vector3d(100, 100, 100));
  EXPECT_EQ(calls_[1].region.start, Eigen::Vector3d(3, 0, 0));
  EXPECT_EQ(calls_[1].region.lower, Eigen::Vector3d(3, -100, 0));
  EXPECT_EQ(calls_[1].region.upper, Eigen::Vector3d(3, 100, 0));
  EXPECT_EQ(calls_[2].region.lower, Eigen::Vector3d(-100, 0, -100));
  EXPECT_EQ(calls_[2].region.upper, Eigen::Vector3d(100, 0, 100));
}

TEST_F(PipelineTest, WithoutGroupsEveryStageMovesAll) {
  add("poses", 1, 1);
  stages_[0].moves = Moves::poses;
  test::RecordingCost cost = away_from(3);
  EXPECT_EQ(minimize(cost, {10}).point[0], 3);
}

TEST_F(PipelineTest, AStageMayBeginAtTheStartAgainAndTheBetterAnswerIsKept) {
  add("forwards", 1, 1, 1, 4);
  add("backwards", -1, 1, 1, 4);
  add("again", 1, 1);
  stages_[1].from = StageStart::start;
  test::RecordingCost cost = away_from(3);
  EXPECT_EQ(minimize(cost, {30}).point[0], 3);
  ASSERT_EQ(calls_.size(), 3u);
  EXPECT_EQ(calls_[1].region.start[0], 0);
  EXPECT_EQ(calls_[2].region.start[0], 3);
}

TEST_F(PipelineTest, StagesHaveSeedsOfTheirOwn) {
  add("a", 0, 1);
  add("b", 0, 1);
  test::RecordingCost cost = away_from(3);
  minimize(cost, {10}, 7);
  EXPECT_EQ(calls_[0].seed, seed_of_part(7, 0));
  EXPECT_EQ(calls_[1].seed, seed_of_part(7, 1));
}

TEST_F(PipelineTest, ABudgetOfTimeIsSharedToo) {
  add("a", 0, 1);
  add("b", 0, 3);
  test::RecordingCost cost = away_from(3);
  minimize(cost, {10, 1000.0});
  EXPECT_NEAR(calls_[0].budget.seconds, 250, 10);
  EXPECT_NEAR(calls_[1].budget.seconds, 1000, 10);
}

TEST_F(PipelineTest, AnErrorOfAStageNamesIt) {
  add("pso", 0, 1);
  stages_.push_back({"levenberg_marquardt", std::make_unique<Failing<ConfigError>>(), 1, 1});
  Pipeline config(std::move(stages_), 100, "scene.yaml:9:3");
  test::RecordingCost cost = away_from(3);
  EXPECT_THAT(
      [&] { config.minimize(cost, line(), {10}, 1); },
      ThrowsMessage<ConfigError>("scene.yaml:9:3: stage 2 of 2, levenberg_marquardt: cannot do "
                                 "that"));

  std::vector<PipelineStage> device;
  device.push_back({"pso_cuda", std::make_unique<Failing<DeviceError>>(), 1, 1});
  Pipeline on_device(std::move(device), 100);
  EXPECT_THAT([&] { on_device.minimize(cost, line(), {10}, 1); },
              ThrowsMessage<DeviceError>(HasSubstr("stage 1 of 1, pso_cuda: cannot do that")));
}

TEST_F(PipelineTest, AnErrorSaysOnlyOnceWhereTheStageIs) {
  const std::string where = "--set optimizer=...";
  stages_.push_back(
      {"pso_cuda", std::make_unique<Failing<ConfigError>>(where + ": cannot do that"), 1, 1});
  Pipeline pipeline(std::move(stages_), 100, where);
  test::RecordingCost cost = away_from(3);
  EXPECT_THAT([&] { pipeline.minimize(cost, line(), {10}, 1); },
              ThrowsMessage<ConfigError>(where + ": stage 1 of 1, pso_cuda: cannot do that"));
}

/// Searches on a GPU only.
class OnDevice final : public Optimizer {
 public:
  Requirements requirements() const override {
    return {.device = true,
            .device_by = "scene.yaml:9:3: on_device",
            .instead_of_device = "`type: pso`"};
  }
  std::int64_t default_evaluations() const override { return 1; }
  OptimizerResult minimize(CostFunction&, const SearchRegion& region, const Budget&,
                           std::uint64_t) override {
    return {region.start};
  }
};

TEST_F(PipelineTest, WhatNeedsADeviceSaysSoWithinOtherOptimizersToo) {
  add("pso", 0, 1);
  EXPECT_FALSE(Pipeline(std::move(stages_), 100, "scene.yaml:9:3").requirements().device);
  std::vector<PipelineStage> stages;
  stages.push_back({"pso", std::make_unique<RandomSearch>(RandomSearchParams{})});
  stages.push_back({"multi_start", std::make_unique<MultiStart>(
                                       MultiStartParams{},
                                       std::make_unique<LimbSearch>(
                                           LimbSearchParams{}, std::make_unique<OnDevice>()))});
  const Requirements all = Pipeline(std::move(stages), 100, "scene.yaml:9:3").requirements();
  EXPECT_THAT([&] { check_requirements(all, CostOffer{}); },
              ThrowsMessage<DeviceError>(
                  "scene.yaml:9:3: stage 2 of 2, multi_start: on_device searches on the GPU, and "
                  "this scene is not evaluated there. Write `evaluate: {backend: cuda}`, or `type: "
                  "pso`"));
}

TEST_F(PipelineTest, WithoutStagesItIsAConfigError) {
  EXPECT_THAT(
      [] { Pipeline({}, 100, "scene.yaml:9:3"); },
      ThrowsMessage<ConfigError>(HasSubstr("scene.yaml:9:3: pipeline: there are no stages")));
}

TEST_F(PipelineTest, PipelinesNest) {
  add("inner a", 1, 1);
  add("inner b", -1, 1);
  auto inner = std::make_unique<Pipeline>(std::move(stages_), 100);
  stages_.clear();
  stages_.push_back({"pipeline", std::move(inner), 1, 0.5});
  add("outer", 1, 1);
  test::RecordingCost cost = away_from(3);
  EXPECT_EQ(minimize(cost, {80}).evaluations, 80);
  EXPECT_THAT(budgets(), ElementsAre(20, 20, 40));
  EXPECT_EQ(calls_[1].region.spread[0], 0.5);
  EXPECT_EQ(calls_[2].region.start[0], 3);
}

}  // namespace
}  // namespace hypotrack
