#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cost/cost.hpp"
#include "hypotrack/api/error.hpp"
#include "observations.hpp"
#include "test_models.hpp"

namespace hypotrack::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A term whose cost is whatever a function makes of a hypothesis.
class Term : public Objective {
 public:
  using Cost = std::function<double(const RenderedHypothesis&)>;
  Term(bool draws, Cost cost) : draws_(draws), cost_(std::move(cost)) {}

  int frame = -1;

 private:
  bool do_needs_rendering() const override { return draws_; }
  void do_prepare(const Observation& observation) override { frame = observation.frame; }
  double do_cost(const RenderedHypothesis& hypothesis) const override { return cost_(hypothesis); }

  bool draws_;
  Cost cost_;
};

/// One whose residuals are the first numbers of a state.
class SquaresOfState : public Objective, public ResidualTerm {
 public:
  explicit SquaresOfState(std::int64_t count) : count_(count) {}

 protected:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {}
  double do_cost(const RenderedHypothesis& hypothesis) const override {
    double sum = 0;
    for (const double x : hypothesis.state.first(static_cast<std::size_t>(count_))) sum += x * x;
    return sum;
  }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return count_; }
  void do_write_residuals(const RenderedHypothesis& hypothesis,
                          std::span<float> residuals) const override {
    for (std::size_t i = 0; i < residuals.size(); ++i)
      residuals[i] = static_cast<float>(hypothesis.state[i]);
  }

 private:
  std::int64_t count_;
};

inline std::shared_ptr<Term> drawn(Term::Cost cost) {
  return std::make_shared<Term>(true, std::move(cost));
}
inline std::shared_ptr<Term> undrawn(Term::Cost cost) {
  return std::make_shared<Term>(false, std::move(cost));
}

/// Sum of 1/z over both tiles: depends on every pixel.
inline double total_inverse_depth(const RenderedHypothesis& hypothesis) {
  double sum = 0;
  for (const DepthTile& tile : hypothesis.views) {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) sum += tile.inverse_depth[y * tile.stride + x];
    }
  }
  return sum;
}

inline EvaluateSettings threads(int count) { return {Backend::cpu, count}; }

class CostTest : public testing::Test {
 protected:
  Eigen::MatrixXd random_states(int count) const {
    std::mt19937_64 random(11);
    Eigen::MatrixXd states(scene_.dimension(), count);
    for (int i = 0; i < count; ++i) states.col(i) = random_state(scene_, random);
    return states;
  }

  Eigen::VectorXd evaluate(std::vector<ObjectiveTerm> terms, const Eigen::MatrixXd& states,
                           const EvaluateSettings& settings = threads(2)) const {
    const auto cost = make_cost(scene_, std::move(terms), settings);
    cost->prepare(observation_);
    Eigen::VectorXd costs = Eigen::VectorXd::Constant(states.cols(), NAN);
    cost->evaluate(states, costs);
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

  Scene scene_ = hand_scene();
  Observation observation_ = rectified_pair(scene_);
};

/// The test hand, posed by its own code.
class SelfPosed : public Model {
 public:
  explicit SelfPosed(int missing = 0) : Model(make_test_hand()), missing_(missing) {}

 private:
  bool do_poses_itself() const override { return true; }
  void do_pose(std::span<const double> parameters, Eigen::Matrix3Xf& vertices,
               Eigen::Matrix3Xd& landmarks) const override {
    Model::do_pose(parameters, vertices, landmarks);
    vertices.conservativeResize(3, vertices.cols() - missing_);
  }

  int missing_;
};

}  // namespace hypotrack::test
