// stereo_color beside a prior with a Jacobian and a term that has residuals only.
#include <gtest/gtest.h>

#include <memory>

#include "cost/cost.hpp"
#include "rendered_pair.hpp"
#include "stereo_color.hpp"
#include "track/tangent.hpp"

namespace hypotrack::stereo_color {
namespace {

/// Pulls the model to a place and a joint to an angle; has a Jacobian.
class Prior final : public Objective, public ResidualTerm {
 public:
  bool needs_rendering() const override { return false; }
  void prepare(const Observation&) override {}
  double cost(const RenderedHypothesis& h) const override {
    float r[2];
    write_residuals(h, r);
    return r[0] * r[0] + r[1] * r[1];
  }
  const ResidualTerm* residual_term() const override { return this; }
  std::int64_t residual_count() const override { return 2; }
  void write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    residuals[0] = static_cast<float>(100 * (h.state[2] * h.state[2] - 0.26));
    residuals[1] = static_cast<float>(5 * (h.state[8] - 0.2));
  }
  bool has_jacobian() const override { return true; }
  void write_jacobian(const RenderedHypothesis& h, std::span<float> residuals,
                      Jacobian& jacobian) const override {
    write_residuals(h, residuals);
    jacobian(0, 2) = static_cast<float>(200 * h.state[2]);
    jacobian(1, 8) = 5;
  }
};

/// Passes an objective's residuals on, and none of their derivatives.
class ResidualsOnly final : public Objective, public ResidualTerm {
 public:
  explicit ResidualsOnly(std::shared_ptr<Objective> objective) : all_(std::move(objective)) {}
  bool needs_rendering() const override { return all_->needs_rendering(); }
  void prepare(const Observation& observation) override { all_->prepare(observation); }
  double cost(const RenderedHypothesis& h) const override { return all_->cost(h); }
  const ResidualTerm* residual_term() const override { return this; }
  std::int64_t residual_count() const override { return all_->residual_term()->residual_count(); }
  void write_residuals(const RenderedHypothesis& h, std::span<float> residuals) const override {
    all_->residual_term()->write_residuals(h, residuals);
  }

 private:
  std::shared_ptr<Objective> all_;
};

std::shared_ptr<Objective> colors(double beta) {
  Params params;
  params.beta = beta;
  params.distinctiveness = Distinctiveness::none;
  params.lookup = Lookup::bilinear;
  params.direction = Direction::both;
  return std::make_shared<StereoColor>(params);
}

class MixedTerms : public testing::Test {
 protected:
  std::unique_ptr<Cost> cost(const std::vector<ObjectiveTerm>& terms) const {
    auto out = make_cost(pair_.scene(), terms, {.backend = Backend::cpu, .threads = 1},
                         {.least_squares = true});
    out->prepare(pair_.observation());
    return out;
  }
  Eigen::MatrixXd around(const Eigen::VectorXd& state, const Eigen::VectorXd& steps) const {
    Eigen::MatrixXd out(state.size(), steps.size() + 1);
    out.col(0) = state;
    for (Eigen::Index i = 0; i < steps.size(); ++i) {
      out.col(i + 1) =
          moved(pair_.scene(), state, steps[i] * Eigen::VectorXd::Unit(steps.size(), i));
    }
    return out;
  }

  /// Returns the mean normal equations of some states, by `equations(states, steps)`. Means, as the
  /// grid of pixels is noise.
  template <class Equations>
  NormalEquations mean(const Equations& equations) const {
    const Eigen::Index d = pair_.truth().size() - 1;
    Eigen::VectorXd steps = Eigen::VectorXd::Constant(d, 0.02);
    steps.head<3>().setConstant(0.8e-3);  // half a pixel
    NormalEquations sum{Eigen::MatrixXd::Zero(d, d), Eigen::VectorXd::Zero(d)};
    constexpr int kStates = 16;
    for (int i = 0; i < kStates; ++i) {
      Eigen::VectorXd state = pair_.truth();
      state[0] += 3e-3 + 0.37e-3 * i;
      state[1] += 0.9e-3 * (i % 5);
      state[2] += 6e-3;
      const NormalEquations one = equations(around(state, steps), around(state, -steps), steps);
      // In units of the steps, which make pixels and priors alike.
      sum.a += steps.asDiagonal() * one.a * steps.asDiagonal() / kStates;
      sum.g += steps.asDiagonal() * one.g / kStates;
    }
    return sum;
  }

  RenderedPair pair_;
};

TEST_F(MixedTerms, GiveTheNormalEquationsOfDifferences) {
  const auto terms = [](const auto& as) {
    return std::vector<ObjectiveTerm>{{1, as(colors(3))},
                                      {0.5, as(std::make_shared<Prior>())},
                                      {0.7, std::make_shared<ResidualsOnly>(colors(2))}};
  };
  const auto mixed = cost(terms([](std::shared_ptr<Objective> term) { return term; }));
  const auto plain = cost(
      terms([](std::shared_ptr<Objective> term) { return std::make_shared<ResidualsOnly>(term); }));
  ASSERT_TRUE(mixed->least_squares()->can_linearize());
  ASSERT_FALSE(plain->least_squares()->can_linearize());
  const NormalEquations found =
      mean([&](const Eigen::MatrixXd& ahead, const Eigen::MatrixXd&, const Eigen::VectorXd& steps) {
        return mixed->least_squares()->linearize(ahead, steps, 1);
      });
  const NormalEquations expected =
      mean([&](const Eigen::MatrixXd& ahead, const Eigen::MatrixXd& behind,
               const Eigen::VectorXd& steps) {
        Eigen::MatrixXf plus(plain->least_squares()->count(), ahead.cols()), minus = plus;
        Eigen::VectorXd costs(ahead.cols());
        plain->least_squares()->evaluate(ahead, plus, costs);
        plain->least_squares()->evaluate(behind, minus, costs);
        const Eigen::MatrixXd j = (plus - minus).rightCols(steps.size()).cast<double>() *
                                  (0.5 * steps.cwiseInverse()).asDiagonal();
        return NormalEquations{j.transpose() * j, j.transpose() * plus.col(0).cast<double>()};
      });
  EXPECT_LT((found.g - expected.g).norm(), 0.1 * expected.g.norm()) << found.g.transpose() << "\n\n"
                                                                    << expected.g.transpose();
  EXPECT_LT((found.a - expected.a).norm(), 0.2 * expected.a.norm())
      << found.a.diagonal().transpose() << "\n\n"
      << expected.a.diagonal().transpose();
}

}  // namespace
}  // namespace hypotrack::stereo_color
