// What terms and callers do wrong.
#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "cost_fixture.hpp"

namespace hypotrack::test {
namespace {

using CostErrors = CostTest;

TEST_F(CostErrors, NamesATermThatReturnsNan) {
  const auto good = undrawn([](const RenderedHypothesis&) { return 1.0; });
  const auto bad = undrawn([](const RenderedHypothesis&) { return std::nan(""); });
  EXPECT_EQ(message<PluginError>({{1, good, "skin"}, {1, bad, "stereo"}}),
            "the objective: the cost of a hypothesis is nan, expected a number or +infinity; this "
            "is a bug in the objective");
  bad->set_label("a.yaml:3:1: objective 'stereo'", "stereo.so");
  EXPECT_THAT(message<PluginError>({{1, good}, {1, bad}}),
              testing::StartsWith("a.yaml:3:1: objective 'stereo' (stereo.so): the cost of a "
                                  "hypothesis is nan"));
  const auto up = undrawn([](const RenderedHypothesis&) { return kInfinity; });
  EXPECT_THAT(message({{1, up}, {-1, up, "other"}}),
              testing::StartsWith("evaluate: objective other adds an infinity to its opposite"));
}

TEST_F(CostErrors, PassesExceptionsOnUnchanged) {
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

TEST_F(CostErrors, CanBeUsedAfterAnException) {
  bool fail = true;
  const auto term = drawn([&](const RenderedHypothesis& h) -> double {
    if (fail) throw std::runtime_error("no");
    return total_inverse_depth(h);
  });
  const auto cost = make_cost(scene_, {{1, term}}, threads(2));
  cost->prepare(observation_);
  const Eigen::MatrixXd states = random_states(10);
  Eigen::VectorXd costs(10);
  EXPECT_THROW(cost->evaluate(states, costs), std::runtime_error);
  fail = false;
  cost->evaluate(states, costs);
  EXPECT_EQ(costs, evaluate({{1, drawn(total_inverse_depth)}}, states));
}

TEST_F(CostErrors, RefusesPosesOfTheWrongSize) {
  const Scene scene({{"hand", std::make_shared<const SelfPosed>(1)}});
  const auto cost = make_cost(scene, {{1, drawn(total_inverse_depth)}}, threads(1));
  cost->prepare(observation_);
  Eigen::VectorXd costs(1);
  try {
    cost->evaluate(scene.rest_state(), costs);
    FAIL();
  } catch (const PluginError& error) {
    EXPECT_STREQ(error.what(),
                 "the model: its pose has 1499 vertices, expected 1500 as in its data; this is a "
                 "bug in the model");
  }
}

TEST_F(CostErrors, RefusesWhatDoesNotFit) {
  const auto cost = make_cost(scene_, {{1, drawn(total_inverse_depth)}}, threads(1));
  Eigen::VectorXd costs(1);
  const auto what = [&](const Eigen::MatrixXd& states) -> std::string {
    try {
      cost->evaluate(states, costs);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(what(random_states(1)), "evaluate: no frame has been prepared");
  cost->prepare(observation_);
  EXPECT_EQ(what(Eigen::MatrixXd::Zero(26, 1)),
            "evaluate: found states 26 x 1 and room for 1 costs, expected states 27 x N and room "
            "for N");
  EXPECT_EQ(what(random_states(2)),
            "evaluate: found states 27 x 2 and room for 1 costs, expected states 27 x N and room "
            "for N");
  EXPECT_EQ(what(random_states(1)), "no error");
}

TEST_F(CostErrors, RefusesTermsThatAreNone) {
  const auto term = undrawn([](const RenderedHypothesis&) { return 0.0; });
  EXPECT_EQ(message({{1, nullptr, "stereo"}}),
            "evaluate: there is no objective behind term stereo");
  EXPECT_EQ(message<ConfigError>({{kInfinity, term, "stereo"}}),
            "evaluate: the weight of objective stereo is inf, expected a finite number");
}

}  // namespace
}  // namespace hypotrack::test
