#include "cost/cost.hpp"

#include <gmock/gmock.h>
#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <opencv2/core.hpp>

#include "cost_fixture.hpp"

namespace hypotrack::test {
namespace {

TEST_F(CostTest, AddsTermsUpWithTheirWeights) {
  const auto first = undrawn([](const RenderedHypothesis& h) { return h.state[0]; });
  const auto second = undrawn([](const RenderedHypothesis& h) { return h.state[2]; });
  const Eigen::MatrixXd states = random_states(20);
  const Eigen::VectorXd costs = evaluate({{2, first}, {-3, second}}, states);
  EXPECT_TRUE(costs.isApprox((2 * states.row(0) - 3 * states.row(2)).transpose(), 1e-15));
}

TEST_F(CostTest, DoesNotDependOnTheNumberOfThreads) {
  const Eigen::MatrixXd states = random_states(60);
  const std::vector<ObjectiveTerm> terms = {{1, drawn(total_inverse_depth)}};
  const Eigen::VectorXd one = evaluate(terms, states, threads(1));
  EXPECT_GT(one.minCoeff(), 100.0);
  for (const int count : {0, 2, 5}) EXPECT_EQ(evaluate(terms, states, threads(count)), one);
}

TEST_F(CostTest, DoesNotDependOnTheOrderInTheBatch) {
  const Eigen::MatrixXd states = random_states(30);
  const std::vector<ObjectiveTerm> terms = {{1, drawn(total_inverse_depth)}};
  const Eigen::VectorXd costs = evaluate(terms, states);
  const Eigen::VectorXd reversed = evaluate(terms, states.rowwise().reverse());
  EXPECT_EQ(reversed.reverse(), costs);
}

TEST_F(CostTest, ShowsNormalizedStates) {
  Eigen::MatrixXd states = random_states(2);
  const Eigen::VectorXd expected = states.col(0);
  states.block<4, 1>(3, 0) *= 4.0;
  states.block<4, 1>(3, 1).setZero();
  std::vector<Eigen::VectorXd> seen(2);
  std::atomic<int> calls = 0;
  const auto term = undrawn([&](const RenderedHypothesis& h) {
    const Eigen::Map<const Eigen::VectorXd> state(h.state.data(), 27);
    seen[state[3] == 1 && state[4] == 0] = state;
    return static_cast<double>(++calls);
  });
  evaluate({{1, term}}, states, threads(1));
  EXPECT_EQ(calls, 2);
  EXPECT_TRUE(seen[0].isApprox(expected, 1e-15));
  EXPECT_EQ(seen[1].segment<4>(3), Eigen::Vector4d(1, 0, 0, 0));
}

TEST_F(CostTest, GivesPicturesOnlyToTermsThatNeedThem) {
  const auto with = drawn([](const RenderedHypothesis& h) { return double(h.views.size()); });
  const auto without = undrawn([](const RenderedHypothesis& h) { return double(h.views.size()); });
  const Eigen::MatrixXd states = random_states(3);
  EXPECT_EQ(evaluate({{1, with}, {10, without}}, states), Eigen::VectorXd::Constant(3, 2));
  EXPECT_EQ(evaluate({{10, without}}, states), Eigen::VectorXd::Zero(3));
}

TEST_F(CostTest, DoesNotDrawForTermsOfWeightZero) {
  const auto never = drawn([](const RenderedHypothesis&) -> double { throw 1; });
  EXPECT_EQ(evaluate({{0, never}}, random_states(3)), Eigen::VectorXd::Zero(3));
}

TEST_F(CostTest, PreparesEveryTerm) {
  const auto term = undrawn([](const RenderedHypothesis&) { return 0.0; });
  const auto off = undrawn([](const RenderedHypothesis&) { return 0.0; });
  observation_.frame = 12;
  evaluate({{1, term}, {0, off}}, random_states(1));
  EXPECT_EQ(term->frame, 12);
  EXPECT_EQ(off->frame, 12);
}

/// Remembers which images it was given.
class Onlooker final : public Objective {
 public:
  explicit Onlooker(ImageUse use) : use_(use) {}

  std::string seen;

 private:
  ImageUse do_image_use() const override { return use_; }
  void do_prepare(const Observation& observation) override {
    seen.clear();
    for (const TileView& view : observation.views) {
      seen += view.color.empty() ? '-' : 'c';
      seen += view.mask.empty() ? '-' : 'm';
      seen += view.depth.empty() ? '-' : 'd';
    }
  }
  double do_cost(const RenderedHypothesis&) const override { return 0; }

  ImageUse use_;
};

TEST_F(CostTest, CutsTheImagesThatAnyOfItsTermsLooksAt) {
  Camera camera;
  camera.width = camera.height = 200;
  camera.fx = camera.fy = 200;
  camera.cx = camera.cy = 99.5;
  const TileMaker tiles(scene_, {camera}, {});
  Frame frame;
  frame.views.push_back({cv::Mat(200, 200, CV_8UC3, cv::Scalar::all(90)),
                         cv::Mat(200, 200, CV_8UC1, cv::Scalar::all(255)),
                         cv::Mat(200, 200, CV_32FC1, cv::Scalar::all(0.5))});
  Eigen::VectorXd state = scene_.rest_state();
  state[2] = 0.5;
  const auto none = std::make_shared<Onlooker>(ImageUse{.mask = false, .depth = false});
  const auto mask = std::make_shared<Onlooker>(ImageUse{.mask = true, .depth = false});
  const auto depth = std::make_shared<Onlooker>(ImageUse{.mask = false, .depth = true});
  const auto seen_with = [&](const std::vector<ObjectiveTerm>& terms) {
    make_cost(scene_, terms, threads(1))->prepare(tiles, frame, tiles.plan(frame, state));
    return none->seen;
  };
  EXPECT_EQ(seen_with({{1, none}}), "c--");
  EXPECT_EQ(seen_with({{1, none}, {1, mask}}), "cm-");
  EXPECT_EQ(seen_with({{1, none}, {0, mask}}), "cm-");  // it is prepared all the same
  EXPECT_EQ(seen_with({{1, none}, {1, depth}}), "c-d");
  EXPECT_EQ(seen_with({{1, none}, {1, undrawn([](const auto&) { return 0.0; })}}), "cmd");
  EXPECT_FALSE(frame.views[0].mask.empty() || frame.views[0].depth.empty());
}

TEST_F(CostTest, DrawsFramesThatItsTermsHaveTakenInForAnother) {
  const auto term = drawn(total_inverse_depth);
  const auto first = make_cost(scene_, {{1, term}}, threads(1)),
             second = make_cost(scene_, {{1, term}}, threads(1));
  const Eigen::MatrixXd states = random_states(6);
  Eigen::VectorXd costs(6);
  first->prepare(observation_);
  term->frame = -1;
  second->prepare_drawing(observation_);
  second->evaluate(states, costs);
  EXPECT_EQ(term->frame, -1);
  EXPECT_EQ(costs, evaluate({{1, term}}, states));
}

TEST_F(CostTest, KeepsInfinity) {
  const auto infeasible = undrawn([](const RenderedHypothesis&) { return kInfinity; });
  EXPECT_EQ(evaluate({{1, infeasible}}, random_states(1))[0], kInfinity);
}

TEST_F(CostTest, KeepsTilesOfParallelTermsApart) {
  // A term that is parallel itself must find its own tile unchanged when it comes back.
  const auto term = drawn([](const RenderedHypothesis& h) {
    const double before = total_inverse_depth(h);
    std::atomic<int> work = 0;
    tbb::parallel_for(0, 64, [&](int i) { work += i; });
    return before == total_inverse_depth(h) ? 0.0 : 1.0;
  });
  EXPECT_EQ(evaluate({{1, term}}, random_states(60), threads(4)), Eigen::VectorXd::Zero(60));
}

TEST_F(CostTest, FollowsTheTilesFromFrameToFrame) {
  const auto term = drawn(total_inverse_depth);
  const auto cost = make_cost(scene_, {{1, term}}, threads(2));
  const Eigen::MatrixXd states = random_states(6);
  for (const int size : {128, 64, 200}) {
    const Observation observation = rectified_pair(scene_, size);
    cost->prepare(observation);
    Eigen::VectorXd costs(6), fresh(6);
    cost->evaluate(states, costs);
    const auto other = make_cost(scene_, {{1, term}}, threads(1));
    other->prepare(observation);
    other->evaluate(states, fresh);
    EXPECT_EQ(costs, fresh) << size;
  }
}

TEST_F(CostTest, EvaluatesAnEmptyBatch) {
  EXPECT_EQ(evaluate({{1, drawn(total_inverse_depth)}}, Eigen::MatrixXd(27, 0)).size(), 0);
}

TEST_F(CostTest, DrawsModelsThatPoseThemselvesLikeOthers) {
  const Scene own({{"box", std::make_shared<const Model>(make_test_box())},
                   {"hand", std::make_shared<const SelfPosed>()}});
  const Scene plain({{"box", std::make_shared<const Model>(make_test_box())},
                     {"hand", std::make_shared<const Model>(make_test_hand())}});
  std::mt19937_64 random(2);
  Eigen::MatrixXd states(34, 8);
  for (int i = 0; i < 8; ++i) states.col(i) = random_state(plain, random);
  Eigen::VectorXd costs[2] = {Eigen::VectorXd(8), Eigen::VectorXd(8)};
  for (int k = 0; k < 2; ++k) {
    const auto cost = make_cost(k ? own : plain, {{1, drawn(total_inverse_depth)}}, threads(2));
    cost->prepare(observation_);
    cost->evaluate(states, costs[k]);
  }
  EXPECT_TRUE(costs[0].isApprox(costs[1], 1e-3));
}

TEST_F(CostTest, SaysWhatDraws) {
  const auto term = drawn(total_inverse_depth);
  const auto one = make_cost(scene_, {{1, term}}, threads(1));
  EXPECT_THAT(one->backend(), testing::MatchesRegex("cpu \\([A-Z0-9_]+, 1 thread\\)"));
  const auto two = make_cost(scene_, {{1, term}}, {.backend = Backend::cpu, .threads = 2});
  EXPECT_THAT(two->backend(), testing::MatchesRegex("cpu \\([A-Z0-9_]+, 2 threads\\)"));
  // A term without the device capability: auto says why it is on the CPU.
  const auto automatic = make_cost(scene_, {{1, term}}, {.threads = 1});
  EXPECT_THAT(automatic->backend(),
              testing::MatchesRegex("cpu \\([A-Z0-9_]+, 1 thread\\); not on a GPU: .+"));
}

}  // namespace
}  // namespace hypotrack::test
