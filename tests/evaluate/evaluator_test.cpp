#include "evaluate/evaluator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "evaluate/hypothesis_renderer.hpp"
#include "expect_error.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/kinematics.hpp"
#include "observations.hpp"
#include "test_models.hpp"

namespace hypotrack {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A term whose cost is whatever a function makes of a hypothesis.
class Term : public Objective {
 public:
  using Cost = std::function<double(const RenderedHypothesis&)>;
  Term(bool draws, Cost cost) : draws_(draws), cost_(std::move(cost)) {}
  bool needs_rendering() const override { return draws_; }
  void prepare(const Observation& observation) override { frame = observation.frame; }
  double cost(const RenderedHypothesis& hypothesis) const override { return cost_(hypothesis); }

  int frame = -1;

 private:
  bool draws_;
  Cost cost_;
};

// One whose residuals are the first numbers of a state.
class SquaresOfState : public Objective, public ResidualTerm {
 public:
  explicit SquaresOfState(std::int64_t count) : count_(count) {}
  bool needs_rendering() const override { return false; }
  void prepare(const Observation&) override {}
  double cost(const RenderedHypothesis& hypothesis) const override {
    double sum = 0;
    for (const double x : hypothesis.state.first(static_cast<std::size_t>(count_))) sum += x * x;
    return sum;
  }
  const ResidualTerm* residual_term() const override { return this; }
  std::int64_t residual_count() const override { return count_; }
  void write_residuals(const RenderedHypothesis& hypothesis,
                       std::span<float> residuals) const override {
    for (std::size_t i = 0; i < residuals.size(); ++i)
      residuals[i] = static_cast<float>(hypothesis.state[i]);
  }

 private:
  std::int64_t count_;
};

std::shared_ptr<Term> drawn(Term::Cost cost) {
  return std::make_shared<Term>(true, std::move(cost));
}
std::shared_ptr<Term> undrawn(Term::Cost cost) {
  return std::make_shared<Term>(false, std::move(cost));
}

// Sum of 1/z over both tiles: depends on every pixel.
double total_inverse_depth(const RenderedHypothesis& hypothesis) {
  double sum = 0;
  for (const DepthTile& tile : hypothesis.views) {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) sum += tile.inverse_depth[y * tile.stride + x];
    }
  }
  return sum;
}

EvaluateSettings threads(int count) { return {Backend::cpu, count}; }

class EvaluatorTest : public testing::Test {
 protected:
  Eigen::MatrixXd random_states(int count) const {
    std::mt19937_64 random(11);
    Eigen::MatrixXd states(scene_.dimension(), count);
    for (int i = 0; i < count; ++i) states.col(i) = test::random_state(scene_, random);
    return states;
  }

  Eigen::VectorXd evaluate(std::vector<ObjectiveTerm> terms, const Eigen::MatrixXd& states,
                           const EvaluateSettings& settings = threads(2)) const {
    Evaluator evaluator(scene_, std::move(terms), settings);
    evaluator.prepare(observation_);
    Eigen::VectorXd costs = Eigen::VectorXd::Constant(states.cols(), NAN);
    evaluator.evaluate(states, costs);
    return costs;
  }

  template <class E = Error>
  std::string message(std::vector<ObjectiveTerm> terms) const {
    try {
      evaluate(std::move(terms), random_states(8));
    } catch (const E& error) {
      return error.what();
    }
    return "no error";
  }

  Scene scene_ = test::hand_scene();
  Observation observation_ = test::rectified_pair(scene_);
};

TEST_F(EvaluatorTest, AddsTermsUpWithTheirWeights) {
  const auto first = undrawn([](const RenderedHypothesis& h) { return h.state[0]; });
  const auto second = undrawn([](const RenderedHypothesis& h) { return h.state[2]; });
  const Eigen::MatrixXd states = random_states(20);
  const Eigen::VectorXd costs = evaluate({{2, first}, {-3, second}}, states);
  EXPECT_TRUE(costs.isApprox((2 * states.row(0) - 3 * states.row(2)).transpose(), 1e-15));
}

TEST_F(EvaluatorTest, DoesNotDependOnTheNumberOfThreads) {
  const Eigen::MatrixXd states = random_states(60);
  const std::vector<ObjectiveTerm> terms = {{1, drawn(total_inverse_depth)}};
  const Eigen::VectorXd one = evaluate(terms, states, threads(1));
  EXPECT_GT(one.minCoeff(), 100.0);
  for (const int count : {0, 2, 5}) EXPECT_EQ(evaluate(terms, states, threads(count)), one);
}

TEST_F(EvaluatorTest, DoesNotDependOnTheOrderInTheBatch) {
  const Eigen::MatrixXd states = random_states(30);
  const std::vector<ObjectiveTerm> terms = {{1, drawn(total_inverse_depth)}};
  const Eigen::VectorXd costs = evaluate(terms, states);
  const Eigen::VectorXd reversed = evaluate(terms, states.rowwise().reverse());
  EXPECT_EQ(reversed.reverse(), costs);
}

TEST_F(EvaluatorTest, ShowsNormalizedStates) {
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

TEST_F(EvaluatorTest, GivesPicturesOnlyToTermsThatNeedThem) {
  const auto with = drawn([](const RenderedHypothesis& h) { return double(h.views.size()); });
  const auto without = undrawn([](const RenderedHypothesis& h) { return double(h.views.size()); });
  const Eigen::MatrixXd states = random_states(3);
  EXPECT_EQ(evaluate({{1, with}, {10, without}}, states), Eigen::VectorXd::Constant(3, 2));
  EXPECT_EQ(evaluate({{10, without}}, states), Eigen::VectorXd::Zero(3));
}

TEST_F(EvaluatorTest, DoesNotDrawForTermsOfWeightZero) {
  const auto never = drawn([](const RenderedHypothesis&) -> double { throw 1; });
  EXPECT_EQ(evaluate({{0, never}}, random_states(3)), Eigen::VectorXd::Zero(3));
}

TEST_F(EvaluatorTest, PreparesEveryTerm) {
  const auto term = undrawn([](const RenderedHypothesis&) { return 0.0; });
  const auto off = undrawn([](const RenderedHypothesis&) { return 0.0; });
  observation_.frame = 12;
  evaluate({{1, term}, {0, off}}, random_states(1));
  EXPECT_EQ(term->frame, 12);
  EXPECT_EQ(off->frame, 12);
}

TEST_F(EvaluatorTest, KeepsInfinity) {
  const auto infeasible = undrawn([](const RenderedHypothesis&) { return kInfinity; });
  EXPECT_EQ(evaluate({{1, infeasible}}, random_states(1))[0], kInfinity);
}

TEST_F(EvaluatorTest, NamesATermThatReturnsNan) {
  const auto good = undrawn([](const RenderedHypothesis&) { return 1.0; });
  const auto bad = undrawn([](const RenderedHypothesis&) { return std::nan(""); });
  const std::string rest =
      " of the batch; this is a bug in the objective: costs are numbers or +infinity";
  EXPECT_THAT(message({{1, good, "skin"}, {1, bad, "stereo"}}),
              testing::AllOf(testing::StartsWith("evaluate: objective stereo returned NaN for "
                                                 "hypothesis "),
                             testing::EndsWith(rest)));
  EXPECT_THAT(message({{1, good}, {1, bad}}),
              testing::StartsWith("evaluate: objective number 2 returned NaN"));
  const auto up = undrawn([](const RenderedHypothesis&) { return kInfinity; });
  EXPECT_THAT(message({{1, up}, {-1, up, "other"}}),
              testing::StartsWith("evaluate: objective other adds an infinity to its opposite"));
}

TEST_F(EvaluatorTest, PassesExceptionsOnUnchanged) {
  struct Own : std::logic_error {
    using std::logic_error::logic_error;
    int detail = 42;
  };
  const auto bad = drawn([](const RenderedHypothesis& h) -> double {
    if (h.state[0] > 0) throw Own("from a term");
    return 0;
  });
  for (const int count : {1, 3}) {
    try {
      evaluate({{1, bad}}, random_states(40), threads(count));
      FAIL();
    } catch (const Own& error) {
      EXPECT_STREQ(error.what(), "from a term");
      EXPECT_EQ(error.detail, 42);
    }
  }
}

TEST_F(EvaluatorTest, CanBeUsedAfterAnException) {
  bool fail = true;
  const auto term = drawn([&](const RenderedHypothesis& h) -> double {
    if (fail) throw std::runtime_error("no");
    return total_inverse_depth(h);
  });
  Evaluator evaluator(scene_, {{1, term}}, threads(2));
  evaluator.prepare(observation_);
  const Eigen::MatrixXd states = random_states(10);
  Eigen::VectorXd costs(10);
  EXPECT_THROW(evaluator.evaluate(states, costs), std::runtime_error);
  fail = false;
  evaluator.evaluate(states, costs);
  EXPECT_EQ(costs, evaluate({{1, drawn(total_inverse_depth)}}, states));
}

TEST_F(EvaluatorTest, KeepsTilesOfParallelTermsApart) {
  // A term that is parallel itself must find its own tile unchanged when it comes back.
  const auto term = drawn([](const RenderedHypothesis& h) {
    const double before = total_inverse_depth(h);
    std::atomic<int> work = 0;
    tbb::parallel_for(0, 64, [&](int i) { work += i; });
    return before == total_inverse_depth(h) ? 0.0 : 1.0;
  });
  EXPECT_EQ(evaluate({{1, term}}, random_states(60), threads(4)), Eigen::VectorXd::Zero(60));
}

TEST_F(EvaluatorTest, FollowsTheTilesFromFrameToFrame) {
  const auto term = drawn(total_inverse_depth);
  Evaluator evaluator(scene_, {{1, term}}, threads(2));
  const Eigen::MatrixXd states = random_states(6);
  for (const int size : {128, 64, 200}) {
    const Observation observation = test::rectified_pair(scene_, size);
    evaluator.prepare(observation);
    Eigen::VectorXd costs(6), fresh(6);
    evaluator.evaluate(states, costs);
    Evaluator other(scene_, {{1, term}}, threads(1));
    other.prepare(observation);
    other.evaluate(states, fresh);
    EXPECT_EQ(costs, fresh) << size;
  }
}

TEST_F(EvaluatorTest, EvaluatesAnEmptyBatch) {
  EXPECT_EQ(evaluate({{1, drawn(total_inverse_depth)}}, Eigen::MatrixXd(27, 0)).size(), 0);
}

// The test hand, posed by its own code.
class SelfPosed : public Model {
 public:
  explicit SelfPosed(int missing = 0) : Model(test::make_test_hand()), missing_(missing) {}
  bool poses_itself() const override { return true; }
  void pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
            Eigen::Matrix3Xd& landmarks) const override {
    Model::pose(parameters, vertices, landmarks);
    vertices.conservativeResize(3, vertices.cols() - missing_);
  }

 private:
  int missing_;
};

TEST_F(EvaluatorTest, DrawsModelsThatPoseThemselvesLikeOthers) {
  const Scene own({{"box", std::make_shared<const Model>(test::make_test_box())},
                   {"hand", std::make_shared<const SelfPosed>()}});
  const Scene plain({{"box", std::make_shared<const Model>(test::make_test_box())},
                     {"hand", std::make_shared<const Model>(test::make_test_hand())}});
  std::mt19937_64 random(2);
  Eigen::MatrixXd states(34, 8);
  for (int i = 0; i < 8; ++i) states.col(i) = test::random_state(plain, random);
  Eigen::VectorXd costs[2] = {Eigen::VectorXd(8), Eigen::VectorXd(8)};
  for (int k = 0; k < 2; ++k) {
    Evaluator evaluator(k ? own : plain, {{1, drawn(total_inverse_depth)}}, threads(2));
    evaluator.prepare(observation_);
    evaluator.evaluate(states, costs[k]);
  }
  EXPECT_TRUE(costs[0].isApprox(costs[1], 1e-3));
}

TEST_F(EvaluatorTest, RefusesPosesOfTheWrongSize) {
  const Scene scene({{"hand", std::make_shared<const SelfPosed>(1)}});
  Evaluator evaluator(scene, {{1, drawn(total_inverse_depth)}}, threads(1));
  evaluator.prepare(observation_);
  Eigen::VectorXd costs(1);
  try {
    evaluator.evaluate(scene.rest_state(), costs);
    FAIL();
  } catch (const PluginError& error) {
    EXPECT_STREQ(error.what(),
                 "a model that poses itself returned 1499 vertices, expected the 1500 of its mesh");
  }
}

TEST_F(EvaluatorTest, RefusesWhatDoesNotFit) {
  Evaluator evaluator(scene_, {{1, drawn(total_inverse_depth)}}, threads(1));
  Eigen::VectorXd costs(1);
  const auto what = [&](const Eigen::MatrixXd& states) -> std::string {
    try {
      evaluator.evaluate(states, costs);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(what(random_states(1)), "evaluate: no frame has been prepared");
  evaluator.prepare(observation_);
  EXPECT_EQ(what(Eigen::MatrixXd::Zero(26, 1)),
            "evaluate: found states 26 x 1 and room for 1 costs, expected states 27 x N and room "
            "for N");
  EXPECT_EQ(what(random_states(2)),
            "evaluate: found states 27 x 2 and room for 1 costs, expected states 27 x N and room "
            "for N");
  EXPECT_EQ(what(random_states(1)), "no error");
}

TEST_F(EvaluatorTest, RefusesTermsThatAreNone) {
  const auto term = undrawn([](const RenderedHypothesis&) { return 0.0; });
  EXPECT_EQ(message({{1, nullptr, "stereo"}}),
            "evaluate: there is no objective behind term stereo");
  EXPECT_EQ(message<ConfigError>({{kInfinity, term, "stereo"}}),
            "evaluate: the weight of objective stereo is inf, expected a finite number");
}

TEST_F(EvaluatorTest, ResidualsOfAllTermsAddUpToTheirWeightedSum) {
  const std::vector<ObjectiveTerm> terms = {{4, std::make_shared<SquaresOfState>(3)},
                                            {0, drawn(total_inverse_depth)},
                                            {1, std::make_shared<SquaresOfState>(10)}};
  const Eigen::MatrixXd states = random_states(40);
  Eigen::MatrixXf expected;
  for (const int count : {1, 3}) {
    Evaluator evaluator(scene_, terms, threads(count), {.wanted = true});
    evaluator.prepare(observation_);
    ASSERT_EQ(evaluator.residual_count(), 13);
    Eigen::MatrixXf residuals(13, 40);
    Eigen::VectorXd costs(40);
    evaluator.evaluate(states, residuals, costs);
    EXPECT_EQ(costs, evaluate(terms, states));
    EXPECT_TRUE(residuals.colwise().squaredNorm().transpose().isApprox(costs.cast<float>(), 1e-5f));
    EXPECT_TRUE(residuals.topRows(3).isApprox(2 * states.topRows(3).cast<float>(), 1e-6f));
    if (expected.size() == 0) expected = residuals;
    EXPECT_EQ(residuals, expected);
  }
}

TEST_F(EvaluatorTest, RefusesResidualsOfTermsThatHaveNone) {
  const auto squares = std::make_shared<SquaresOfState>(3);
  const auto plain = undrawn([](const RenderedHypothesis&) { return 0.0; });
  const auto why = [&](std::vector<ObjectiveTerm> terms, Backend backend) -> std::string {
    try {
      Evaluator(scene_, std::move(terms), {.backend = backend}, {.wanted = true});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(
      why({{1, squares}, {1, plain, "prior"}}, Backend::cpu),
      testing::StartsWith("objective: the optimizer needs residuals: objective prior, as it "
                          "is set up, offers no residuals"));
  EXPECT_THAT(why({{-2, squares, "prior"}}, Backend::cpu),
              testing::HasSubstr("the weight of objective prior is -2, and squares cannot be"));
  EXPECT_EQ(why({{1, squares}, {0, plain}}, Backend::cpu), "no error");
}

TEST_F(EvaluatorTest, TakesAnalyticJacobiansOnTheCpu) {
  const std::vector<ObjectiveTerm> terms = {{1, std::make_shared<SquaresOfState>(3)}};
  for (const auto linearization : {Linearization::needed, Linearization::welcome}) {
    const Evaluator automatic(scene_, terms, {}, {true, linearization});
    EXPECT_THAT(automatic.backend(),
                testing::HasSubstr("not on a GPU: the optimizer takes analytic Jacobians"));
  }
  EXPECT_THAT(test::message_of<ConfigError>([&] {
                Evaluator(scene_, terms, {.backend = Backend::cuda}, {true, Linearization::needed});
              }),
              testing::StartsWith("evaluate.backend: cuda: the optimizer takes analytic Jacobians, "
                                  "which are computed on the CPU. Write `jacobian: automatic`"));
}

TEST_F(EvaluatorTest, SaysWhichResidualsLookAtThePoseOnlyWhereItFellBackToo) {
  struct DrawnSquares final : SquaresOfState {
    using SquaresOfState::SquaresOfState;
    bool needs_rendering() const override { return true; }
  };
  for (const auto backend : {Backend::cpu, Backend::automatic}) {
    Evaluator evaluator(
        scene_, {{1, std::make_shared<DrawnSquares>(4)}, {1, std::make_shared<SquaresOfState>(3)}},
        {.backend = backend, .threads = 1}, {.wanted = true});
    evaluator.prepare(observation_);
    const std::vector<ResidualRows> rows = evaluator.pose_only_residuals();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].first, 4);
    EXPECT_EQ(rows[0].count, 3);
  }
}

TEST_F(EvaluatorTest, SaysWhetherThereAreResidualsThatNobodyAnnounced) {
  EXPECT_TRUE(
      Evaluator(scene_, {{1, std::make_shared<SquaresOfState>(3)}}, threads(1)).has_residuals());
  EXPECT_FALSE(Evaluator(scene_, {{1, drawn(total_inverse_depth)}}, threads(1)).has_residuals());
}

TEST_F(EvaluatorTest, SaysWhatDraws) {
  const auto term = drawn(total_inverse_depth);
  const Evaluator one(scene_, {{1, term}}, threads(1));
  EXPECT_THAT(one.backend(), testing::MatchesRegex("cpu \\([A-Z0-9_]+, 1 thread\\)"));
  const Evaluator two(scene_, {{1, term}}, {.backend = Backend::cpu, .threads = 2});
  EXPECT_THAT(two.backend(), testing::MatchesRegex("cpu \\([A-Z0-9_]+, 2 threads\\)"));
  // A term without the device capability: automatic says why it is on the CPU.
  const Evaluator automatic(scene_, {{1, term}}, {.threads = 1});
  EXPECT_THAT(automatic.backend(),
              testing::MatchesRegex("cpu \\([A-Z0-9_]+, 1 thread\\); not on a GPU: .+"));
}

}  // namespace
}  // namespace hypotrack
