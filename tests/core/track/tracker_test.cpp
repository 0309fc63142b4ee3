#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "expect_error.hpp"
#include "hypotrack/api/error.hpp"
#include "shiny_ball.hpp"
#include "test_models.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Distance of the model's position from a target that moves 5 mm per frame along x.
class MovingTarget final : public Objective, public ResidualTerm {
 public:
  int most_threads = 0;
  bool infeasible = false;
  bool offers_residuals = true;

  struct Observed {
    bool start_is_guess;
    Eigen::VectorXd start;
  };
  std::vector<Observed> observed;

 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation& observation) override {
    x_ = 0.005 * observation.frame;
    observed.push_back({observation.context.start_is_guess, observation.start});
    most_threads = tbb::this_task_arena::max_concurrency();
  }
  double do_cost(const RenderedHypothesis& h) const override {
    if (infeasible) return std::numeric_limits<double>::infinity();
    return std::hypot(h.state[0] - x_, h.state[1], h.state[2] - 0.5);
  }
  const ResidualTerm* do_residual_term() const override {
    return offers_residuals ? this : nullptr;
  }
  std::int64_t do_residual_count() const override { return 3; }
  void do_write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    for (std::size_t i = 0; i < 3; ++i) residuals[i] = static_cast<float>(h.state[i]);
    residuals[0] -= static_cast<float>(x_);
    residuals[2] -= 0.5F;
  }

  double x_ = 0;
};

/// The best of normal samples; remembers what it was asked.
class Sampling final : public Optimizer {
 public:
  Requirements requirements() const override {
    return {.device = needs_device, .device_by = "scene.yaml:9:3: sampling"};
  }
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
    points = points.cwiseMax(region.lower.replicate(1, points.cols()))
                 .cwiseMin(region.upper.replicate(1, points.cols()));
    points.col(0) = region.start;
    Eigen::VectorXd costs(points.cols());
    cost.evaluate(points, costs);
    Eigen::Index best = 0;
    const double lowest = costs.minCoeff(&best);
    if (nan_in_answer) points(0, best) = std::nan("");
    return {points.col(best), nan_as_cost ? std::nan("") : lowest, budget.evaluations};
  }
  std::vector<Eigen::VectorXd> starts;
  std::vector<std::int64_t> budgets;
  bool needs_device = false;
  bool nan_in_answer = false, nan_as_cost = false;
};

struct TrackedBox {
  Scene scene{{{"box", std::make_shared<Model>(test::make_test_box())}}};
  std::shared_ptr<MovingTarget> target = std::make_shared<MovingTarget>();
  Sampling* optimizer = nullptr;
  SearchSettings search;
  OneEuroSettings one_euro;
  StatusSettings status;
  bool needs_device = false;
  int threads = 1;

  Eigen::VectorXd start() const {
    Eigen::VectorXd state = scene.rest_state();
    state[2] = 0.5;
    return state;
  }
  SceneTracker make(std::uint64_t seed, std::int64_t evaluations = 0) {
    TrackerParts parts;
    Camera camera{640, 480, 500, 500, 319.5, 239.5, DistortionModel::none, {}, {}};
    camera.camera_from_world = Eigen::Isometry3d::Identity();
    parts.cameras = {camera, camera};
    parts.cameras[1].camera_from_world.translation().x() = -0.06;
    auto sampling = std::make_unique<Sampling>();
    optimizer = sampling.get();
    optimizer->needs_device = needs_device;
    parts.optimizer = std::move(sampling);
    parts.objective = {{1.0, target}};
    parts.evaluate.threads = threads;
    parts.budget.evaluations = evaluations;
    parts.search = search;
    parts.one_euro = one_euro;
    parts.status = status;
    return SceneTracker(scene, std::move(parts), start(), seed);
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
  TrackedBox fixture;
  SceneTracker tracker = fixture.make(1);
  for (int i = 0; i < 12; ++i) {
    const Solution solution = tracker.track(grey_frame(i));
    EXPECT_LT(std::abs(solution.state[0] - 0.005 * i), 0.015) << i;
    EXPECT_EQ(solution.evaluations, 300);
    EXPECT_EQ(solution.frame, i);
  }
}

TEST(Tracker, RefusesAnOptimizerThatNeedsADeviceOnTheCpu) {
  TrackedBox fixture;
  fixture.needs_device = true;
  EXPECT_EQ(test::message_of<DeviceError>([&] { fixture.make(1); }),
            "scene.yaml:9:3: sampling searches on the GPU, and this scene is not evaluated there. "
            "Write `evaluate: {backend: cuda}`");
}

TEST(Tracker, IsLostBesideTheForegroundAndSaysSoOfAStart) {
  TrackedBox fixture;
  SceneTracker tracker = fixture.make(1);
  const auto masked = [](int index, cv::Rect first, cv::Rect second) {
    Frame frame = grey_frame(index);
    for (View& view : frame.views) view.mask = cv::Mat(480, 640, CV_8UC1, cv::Scalar(0));
    frame.views[0].mask(first).setTo(255);
    frame.views[1].mask(second).setTo(255);
    return frame;
  };
  const cv::Rect middle(200, 120, 240, 240), corner(0, 0, 40, 40);
  EXPECT_EQ(tracker.problem_of_start(masked(0, middle, middle)), "");
  EXPECT_EQ(tracker.problem_of_start(grey_frame(0)), "");
  EXPECT_THAT(tracker.problem_of_start(masked(0, corner, corner)),
              AllOf(HasSubstr("cover no foreground pixel of any mask"), HasSubstr("counts as lost"),
                    HasSubstr("(calibration)")));
  EXPECT_THAT(tracker.problem_of_start(masked(0, middle, corner)),
              AllOf(HasSubstr("on the foreground of all masks"), HasSubstr("counts as uncertain")));
  EXPECT_EQ(tracker.track(masked(0, middle, middle)).status, Status::tracked);
  EXPECT_EQ(tracker.track(masked(1, middle, corner)).status, Status::uncertain);
  EXPECT_EQ(tracker.track(masked(2, corner, corner)).status, Status::lost);
  EXPECT_EQ(tracker.track(masked(3, middle, middle)).status, Status::tracked);
}

TEST(Tracker, SearchesFromTheLastSolutionWithoutPrediction) {
  TrackedBox fixture;
  fixture.search.prediction.velocity = Prediction::none;
  SceneTracker tracker = fixture.make(1);
  Eigen::VectorXd last = fixture.start();
  for (int i = 0; i < 5; ++i) {
    const Solution solution = tracker.track(grey_frame(i));
    EXPECT_LT((fixture.optimizer->starts.back() - last).cwiseAbs().maxCoeff(), 1e-12) << i;
    last = solution.state;
  }
}

TEST(Tracker, SearchesAnewFromTheStartWhenAskedTo) {
  TrackedBox fixture;
  SceneTracker tracker = fixture.make(1);
  for (int i = 0; i < 5; ++i) tracker.track(grey_frame(i));
  EXPECT_NE(fixture.optimizer->starts.back(), fixture.start());
  tracker.search_anew();
  tracker.track(grey_frame(5));
  EXPECT_EQ(fixture.optimizer->starts.back(), fixture.start());
  tracker.track(grey_frame(6));
  EXPECT_NE(fixture.optimizer->starts.back(), fixture.start());
}

TEST(Tracker, SearchesFromWhereTheMotionLeads) {
  TrackedBox fixture;
  fixture.search.prediction.velocity = Prediction::constant;
  fixture.search.prediction.gain = 1;
  SceneTracker tracker = fixture.make(1);
  std::vector<Eigen::VectorXd> states;
  for (int i = 0; i < 5; ++i) {
    states.push_back(tracker.track(grey_frame(i)).state);
    if (i < 2) continue;
    const auto n = static_cast<std::size_t>(i);
    const Eigen::Vector3d led = 2 * states[n - 1].head<3>() - states[n - 2].head<3>();
    EXPECT_LT((fixture.optimizer->starts.back().head<3>() - led).norm(), 1e-12) << i;
  }
}

TEST(Tracker, SearchesFromTheShareOfTheMotionThatFitsTheFrameBest) {
  TrackedBox fixture;
  fixture.search.prediction.velocity = Prediction::adaptive;
  SceneTracker tracker = fixture.make(1);
  std::vector<Eigen::Vector3d> found;
  for (int i = 0; i < 8; ++i) {
    const Solution solution = tracker.track(grey_frame(i));
    found.emplace_back(solution.state.head<3>());
    EXPECT_EQ(solution.evaluations, 300) << i;
    EXPECT_EQ(fixture.optimizer->budgets.back(), i < 2 ? 300 : 291) << i;
    if (i < 2) continue;
    const auto n = static_cast<std::size_t>(i);
    const Eigen::Vector3d target(0.005 * i, 0, 0.5), motion = found[n - 1] - found[n - 2];
    double nearest = 1;
    for (const double share : {0.0, 0.5, 1.0})
      nearest = std::min(nearest, (found[n - 1] + share * motion - target).norm());
    const Eigen::Vector3d start = fixture.optimizer->starts.back().head<3>();
    EXPECT_NEAR((start - target).norm(), nearest, 1e-9) << i;
  }
}

TEST(Tracker, SpendsNoSmallBudgetOnPrediction) {
  TrackedBox fixture;
  fixture.search.prediction.velocity = Prediction::adaptive;
  SceneTracker tracker = fixture.make(1, 9);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(tracker.track(grey_frame(i)).evaluations, 9);
  EXPECT_EQ(fixture.optimizer->budgets.back(), 9);
}

TEST(Tracker, LooksAgainFromWhatItFoundFirstWhereNothingWasKnown) {
  TrackedBox fixture;
  fixture.search.second_search = 0.3;
  SceneTracker tracker = fixture.make(1);
  const Solution first = tracker.track(grey_frame(3));
  EXPECT_EQ(fixture.optimizer->budgets, (std::vector<std::int64_t>{210, 90}));
  EXPECT_EQ(first.evaluations, 300);
  ASSERT_EQ(fixture.target->observed.size(), 2);
  EXPECT_TRUE(fixture.target->observed[0].start_is_guess);
  EXPECT_EQ(fixture.target->observed[0].start, fixture.start());
  EXPECT_FALSE(fixture.target->observed[1].start_is_guess);
  EXPECT_EQ(fixture.target->observed[1].start, fixture.optimizer->starts[1]);
  EXPECT_NE(fixture.optimizer->starts[1], fixture.start());

  tracker.track(grey_frame(4));
  EXPECT_EQ(fixture.optimizer->budgets.size(), 3) << "once is enough from a solution";
  EXPECT_EQ(fixture.optimizer->budgets.back(), 300);
  ASSERT_EQ(fixture.target->observed.size(), 3);
  EXPECT_FALSE(fixture.target->observed[2].start_is_guess);
}

TEST(Tracker, LooksAgainUntilSomethingIsFound) {
  TrackedBox fixture;
  fixture.search.second_search = 0.3;
  fixture.target->infeasible = true;
  SceneTracker tracker = fixture.make(1);
  tracker.track(grey_frame(0));
  tracker.track(grey_frame(1));
  EXPECT_EQ(fixture.optimizer->budgets.size(), 4);
  EXPECT_TRUE(fixture.target->observed[2].start_is_guess);
}

TEST(Tracker, LooksOnceUnlessItIsToldOtherwise) {
  TrackedBox fixture;
  SceneTracker tracker = fixture.make(1);
  tracker.track(grey_frame(0));
  EXPECT_EQ(fixture.optimizer->budgets, (std::vector<std::int64_t>{300}));
  EXPECT_TRUE(fixture.target->observed.at(0).start_is_guess);
}

TEST(Tracker, SpendsABudgetOfOneOnTheFirstLook) {
  TrackedBox fixture;
  fixture.search.second_search = 0.9;
  SceneTracker tracker = fixture.make(1, 1);
  EXPECT_EQ(tracker.track(grey_frame(0)).evaluations, 1);
  EXPECT_EQ(fixture.optimizer->budgets, (std::vector<std::int64_t>{1}));
}

TEST(Tracker, StaysWhereItIsIfMotionLeadsOutOfView) {
  TrackedBox fixture;
  fixture.search.prediction.velocity = Prediction::constant;
  fixture.search.prediction.gain = 1;
  SceneTracker tracker = fixture.make(1);
  Frame first = grey_frame(0), second = grey_frame(1), third = grey_frame(2);
  tracker.track(first);
  second.time = first.time + 1e-4;  // so that the way to the third frame is hundreds as long
  const Solution last = tracker.track(second);
  third.time = second.time + 0.05;
  tracker.track(third);
  EXPECT_LT((fixture.optimizer->starts.back() - last.state).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Tracker, SmoothsWhatItGivesOutAndNotWhereItSearches) {
  TrackedBox plain, smooth;
  smooth.one_euro.enabled = true;
  SceneTracker a = plain.make(1), b = smooth.make(1);
  double largest = 0;
  for (int i = 0; i < 8; ++i) {
    const Solution found = a.track(grey_frame(i)), given = b.track(grey_frame(i));
    EXPECT_EQ(plain.optimizer->starts.back(), smooth.optimizer->starts.back()) << i;
    EXPECT_EQ(found.cost, given.cost);
    largest = std::max(largest, (found.state - given.state).head<3>().norm());
  }
  EXPECT_GT(largest, 1e-4);
}

TEST(Tracker, EqualSeedsAgreeAndOthersDiffer) {
  TrackedBox fixture;
  SceneTracker a = fixture.make(7), b = fixture.make(7), c = fixture.make(8);
  const Frame frame = grey_frame(1);
  const Eigen::VectorXd state = a.track(frame).state;
  EXPECT_EQ(state, b.track(frame).state);
  EXPECT_NE(state, c.track(frame).state);
}

TEST(Tracker, TheScenesBudgetReplacesTheOptimizersOwn) {
  TrackedBox fixture;
  SceneTracker tracker = fixture.make(1, 40);
  EXPECT_EQ(tracker.track(grey_frame(0)).evaluations, 40);
}

TEST(Tracker, AMissingFrameKeepsTheState) {
  TrackedBox fixture;
  SceneTracker tracker = fixture.make(1);
  const Solution before = tracker.track(grey_frame(0));
  Frame missing;
  missing.index = 1;
  missing.problem = "no such file";
  const Solution solution = tracker.track(missing);
  EXPECT_EQ(solution.status, Status::missing);
  EXPECT_EQ(solution.state, before.state);
  EXPECT_TRUE(std::isnan(solution.cost));
}

TEST(Tracker, SaysHowFarOffEveryLandmarkMayBeIfItIsToldTo) {
  TrackedBox fixture;
  EXPECT_EQ(fixture.make(1).track(grey_frame(0)).sigma.size(), 0);
  fixture.status.uncertainty.enabled = true;
  SceneTracker tracker = fixture.make(1);
  const Solution solution = tracker.track(grey_frame(0));
  ASSERT_EQ(solution.sigma.size(), 3);
  EXPECT_TRUE(solution.sigma.allFinite());
  // The target has no rotation, so only the centre is known: the ends of the axes keep the prior.
  EXPECT_LT(solution.sigma[0], 0.5 * solution.sigma[1]);
  Frame missing;
  missing.index = 1;
  EXPECT_TRUE(tracker.track(missing).sigma.array().isNaN().all());
}

TEST(Tracker, TakesWhatSigmasNeedOffTheBudgetOfTheSearch) {
  TrackedBox fixture;
  fixture.status.uncertainty.enabled = true;
  SceneTracker tracker = fixture.make(1, 100);
  EXPECT_EQ(tracker.track(grey_frame(0)).evaluations, 100);
  EXPECT_EQ(fixture.optimizer->budgets.front(), 100 - 13);  // 2 * 6 numbers of a box, and one
  EXPECT_THAT(test::message_of<ConfigError>([&] { fixture.make(1, 25); }),
              AllOf(HasSubstr("uncertainty takes 13 evaluations"), HasSubstr("which is 25"),
                    HasSubstr("budget.evaluations 26 or more")));
}

TEST(Tracker, NeedsResidualsToSayHowFarOffLandmarksMayBe) {
  TrackedBox fixture;
  fixture.status.uncertainty.enabled = true;
  fixture.target->offers_residuals = false;
  EXPECT_THAT(test::message_of<ConfigError>([&] { fixture.make(1); }),
              AllOf(HasSubstr("offers no residuals"), HasSubstr("leave uncertainty off")));
}

TEST(Tracker, IsUncertainWhereSigmasAreLarge) {
  TrackedBox fixture;
  fixture.status.uncertainty.enabled = true;
  fixture.status.uncertain_sigma = 1e-6;
  EXPECT_EQ(fixture.make(1).track(grey_frame(0)).status, Status::uncertain);
  fixture.status.lost_sigma = 1e-6;
  EXPECT_EQ(fixture.make(1).track(grey_frame(0)).status, Status::lost);
}

TEST(Tracker, AnInfeasibleFrameIsLostAndKeepsTheState) {
  TrackedBox fixture;
  SceneTracker tracker = fixture.make(1);
  const Solution before = tracker.track(grey_frame(0));
  fixture.target->infeasible = true;
  const Solution solution = tracker.track(grey_frame(1));
  EXPECT_EQ(solution.status, Status::lost);
  EXPECT_EQ(solution.state, before.state);
}

TEST(Tracker, RefusesAnAnswerThatIsNoNumber) {
  for (const bool as_cost : {false, true}) {
    TrackedBox fixture;
    SceneTracker tracker = fixture.make(1);
    tracker.track(grey_frame(0));
    (as_cost ? fixture.optimizer->nan_as_cost : fixture.optimizer->nan_in_answer) = true;
    const std::string message =
        test::message_of<PluginError>([&] { tracker.track(grey_frame(1)); });
    EXPECT_NE(message.find("this is a bug in the optimizer"), std::string::npos) << message;
    EXPECT_EQ(message.find("cost nan") != std::string::npos, as_cost) << message;
  }
}

TEST(Tracker, UsesNoMoreThreadsThanTheSettingsSay) {
  for (const int threads : {1, 3}) {
    TrackedBox fixture;
    fixture.threads = threads;
    fixture.make(1).track(grey_frame(0));
    EXPECT_EQ(fixture.target->most_threads, threads);
  }
}

/// Remembers the second view's tile of the last frame; every pose is as good as another.
class Remembering final : public Objective {
 public:
  cv::Mat tile;

 private:
  bool do_needs_rendering() const override { return true; }
  void do_prepare(const Observation& observation) override {
    tile = observation.views[1].color.clone();
  }
  double do_cost(const RenderedHypothesis&) const override { return 0; }
};

/// The second view's tile of a shiny ball's third frame, as the objective gets it and as seen()
/// returns it.
struct ShinyTiles {
  explicit ShinyTiles(bool highlights) {
    const test::ShinyBall ball;
    const auto objective = std::make_shared<Remembering>();
    TrackerParts parts;
    parts.cameras = ball.cameras;
    parts.optimizer = std::make_unique<Sampling>();
    parts.objective = {{1.0, objective}};
    parts.evaluate = {.backend = Backend::cpu, .threads = 1};
    parts.photometric.highlights = highlights;
    parts.budget.evaluations = 1;  // the start
    SceneTracker tracker(ball.scene, std::move(parts), ball.state(), 1);
    for (int i = 0; i < 3; ++i) {
      Frame frame = ball.frame(60);
      frame.index = i;
      frame.time = i / 30.0;
      tracker.track(frame);
      seen = tracker.seen(frame).views[1].color;
    }
    prepared = objective->tile;
  }
  cv::Mat prepared, seen;
};

TEST(Tracker, TakesHighlightsOffTheTilesOfFramesAfterTheFirst) {
  const ShinyTiles with(true), without(false);
  EXPECT_GT(cv::norm(with.prepared, without.prepared, cv::NORM_INF), 15);
}

TEST(Tracker, LeavesHighlightsInTheTilesThatOthersMayTakeThemOff) {
  const ShinyTiles with(true), without(false);
  EXPECT_EQ(cv::norm(without.seen, without.prepared, cv::NORM_INF), 0);
  EXPECT_LT(cv::norm(with.seen, without.seen, cv::NORM_INF), 4) << "but for the colour map";
}

}  // namespace
}  // namespace hypotrack
