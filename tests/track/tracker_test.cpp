#include "track/tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "test_models.hpp"

namespace hypotrack {
namespace {

/// Distance of the model's position from a target that moves 5 mm per frame along x.
class MovingTarget final : public Objective {
 public:
  bool needs_rendering() const override { return false; }
  void prepare(const Observation& observation) override { x_ = 0.005 * observation.frame; }
  double cost(const RenderedHypothesis& h) const override {
    if (infeasible) return std::numeric_limits<double>::infinity();
    return std::hypot(h.state[0] - x_, h.state[1], h.state[2] - 0.5);
  }
  bool infeasible = false;

 private:
  double x_ = 0;
};

/// The best of normal samples; remembers what it was asked.
class Sampling final : public Optimizer {
 public:
  std::int64_t default_evaluations() const override { return 300; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override {
    starts.push_back(region.start);
    budgets.push_back(budget.evaluations);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Eigen::MatrixXd points(cost.dimension(), budget.evaluations);
    for (auto& x : points.reshaped()) x = 0.3 * normal(random);
    points = (points.array().colwise() * region.spread.array()).matrix().colwise() + region.start;
    points.col(0) = region.start;
    Eigen::VectorXd costs(points.cols());
    cost.evaluate(points, costs);
    Eigen::Index best = 0;
    const double lowest = costs.minCoeff(&best);
    return {points.col(best), lowest, budget.evaluations};
  }
  std::vector<Eigen::VectorXd> starts;
  std::vector<std::int64_t> budgets;
};

struct Fixture {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  std::shared_ptr<MovingTarget> target = std::make_shared<MovingTarget>();
  Sampling* optimizer = nullptr;

  Eigen::VectorXd start() const {
    Eigen::VectorXd state = scene.rest_state();
    state[2] = 0.5;
    return state;
  }
  Tracker make(std::uint64_t seed, std::int64_t evaluations = 0) {
    TrackerParts parts;
    Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world = Eigen::Isometry3d::Identity();
    parts.cameras = {camera, camera};
    parts.cameras[1].camera_from_world.translation().x() = -0.06;
    auto sampling = std::make_unique<Sampling>();
    optimizer = sampling.get();
    parts.optimizer = std::move(sampling);
    parts.objective = {{1.0, target}};
    parts.evaluate.threads = 1;
    parts.budget.evaluations = evaluations;
    return Tracker(scene, std::move(parts), start(), seed);
  }
};

Frame grey_frame(int index) {
  Frame frame;
  frame.index = index;
  frame.time = index / 30.0;
  frame.views.resize(2);
  for (View& view : frame.views) view.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar(90, 90, 90));
  return frame;
}

TEST(Tracker, FollowsATargetFromFrameToFrame) {
  Fixture fixture;
  Tracker tracker = fixture.make(1);
  for (int i = 0; i < 12; ++i) {
    const Solution solution = tracker.track(grey_frame(i));
    EXPECT_LT(std::abs(solution.state[0] - 0.005 * i), 0.015) << i;
    EXPECT_EQ(solution.evaluations, 300);
    EXPECT_EQ(solution.frame, i);
  }
}

TEST(Tracker, SearchesFromTheLastSolution) {
  Fixture fixture;
  Tracker tracker = fixture.make(1);
  const Solution first = tracker.track(grey_frame(0));
  tracker.track(grey_frame(1));
  ASSERT_EQ(fixture.optimizer->starts.size(), 2u);
  EXPECT_LT((fixture.optimizer->starts[1] - first.state).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Tracker, EqualSeedsAgreeAndOthersDiffer) {
  Fixture fixture;
  Tracker a = fixture.make(7), b = fixture.make(7), c = fixture.make(8);
  const Frame frame = grey_frame(1);
  const Eigen::VectorXd state = a.track(frame).state;
  EXPECT_EQ(state, b.track(frame).state);
  EXPECT_NE(state, c.track(frame).state);
}

TEST(Tracker, TheScenesBudgetReplacesTheOptimizersOwn) {
  Fixture fixture;
  Tracker tracker = fixture.make(1, 40);
  EXPECT_EQ(tracker.track(grey_frame(0)).evaluations, 40);
}

TEST(Tracker, AMissingFrameKeepsTheState) {
  Fixture fixture;
  Tracker tracker = fixture.make(1);
  const Solution before = tracker.track(grey_frame(0));
  Frame missing;
  missing.index = 1;
  missing.problem = "no such file";
  const Solution solution = tracker.track(missing);
  EXPECT_EQ(solution.status, Status::missing);
  EXPECT_EQ(solution.state, before.state);
  EXPECT_TRUE(std::isnan(solution.cost));
}

TEST(Tracker, AnInfeasibleFrameIsLostAndKeepsTheState) {
  Fixture fixture;
  Tracker tracker = fixture.make(1);
  const Solution before = tracker.track(grey_frame(0));
  fixture.target->infeasible = true;
  const Solution solution = tracker.track(grey_frame(1));
  EXPECT_EQ(solution.status, Status::lost);
  EXPECT_EQ(solution.state, before.state);
}

}  // namespace
}  // namespace hypotrack
