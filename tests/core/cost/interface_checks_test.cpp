// What the public functions of objectives check of the answers of plugins.
#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "cost/term_times.hpp"
#include "cost_fixture.hpp"
#include "expect_error.hpp"

namespace hypotrack::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// An objective with two residuals that is wrong as asked.
class Faulty final : public Objective, public ResidualTerm {
 public:
  double cost_is = 0;
  std::int64_t count_is = 2;
  float residual_is = 0, slope_is = 0;
  bool transposes = false, throws = false;

 private:
  bool do_needs_rendering() const override { return false; }
  void do_prepare(const Observation&) override {
    if (throws) throw std::runtime_error("no luck");
  }
  double do_cost(const RenderedHypothesis&) const override { return cost_is; }
  const ResidualTerm* do_residual_term() const override { return this; }
  std::int64_t do_residual_count() const override { return count_is; }
  void do_write_residuals(const RenderedHypothesis&, std::span<float> residuals) const override {
    residuals[0] = 0;
    residuals[1] = residual_is;
  }
  void do_write_slopes(const RenderedHypothesis& hypothesis, std::size_t,
                       std::span<float> residuals, std::span<float> slopes) const override {
    do_write_residuals(hypothesis, residuals);
    slopes[0] = slope_is;
  }
  void do_write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                         Jacobian& jacobian) const override {
    do_write_residuals(hypothesis, residuals);
    jacobian(1, 2) = slope_is;
    if (transposes) jacobian.transposeInPlace();
  }
};

class InterfaceChecks : public testing::Test {
 protected:
  InterfaceChecks() { objective_.set_label("a.yaml:3:1: objective 'faulty'", "faulty.so"); }

  template <class Function>
  static std::string error(Function&& function) {
    std::string message = message_of<PluginError>(function);
    EXPECT_THAT(message, StartsWith("a.yaml:3:1: objective 'faulty' (faulty.so): "));
    return message;
  }

  const RenderedHypothesis nothing_;
  Faulty objective_;
  std::vector<float> residuals_ = std::vector<float>(2), slopes_ = std::vector<float>(2);
};

TEST_F(InterfaceChecks, CostsAreNumbersOrPlusInfinity) {
  for (const double wrong : {std::nan(""), -kInfinity}) {
    objective_.cost_is = wrong;
    EXPECT_THAT(error([&] { objective_.cost(nothing_); }), HasSubstr("expected a number or +inf"));
    EXPECT_THAT(error([&] { objective_.cost_and_residuals(nothing_, residuals_); }),
                HasSubstr("expected a number or +infinity"));
    std::vector<double> costs(1);
    EXPECT_THAT(error([&] {
                  objective_.costs({&nothing_, 1}, costs);
                }),
                HasSubstr("expected a number or +infinity"));
  }
  objective_.cost_is = kInfinity;
  objective_.residual_is = NAN;  // of no importance where the cost is infinite
  EXPECT_EQ(objective_.cost_and_residuals(nothing_, residuals_), kInfinity);
}

TEST_F(InterfaceChecks, ResidualsNameTheObjectiveOnceItWasAskedForThem) {
  objective_.residual_is = NAN;
  EXPECT_THAT(message_of<PluginError>([&] { objective_.write_residuals(nothing_, residuals_); }),
              StartsWith("the objective: its residuals have nan in place 1 of 2"));
  const ResidualTerm& term = *objective_.residual_term();
  EXPECT_THAT(error([&] { term.write_residuals(nothing_, residuals_); }),
              HasSubstr("its residuals have nan in place 1 of 2, expected finite numbers"));
  EXPECT_THAT(error([&] { objective_.cost_and_residuals(nothing_, residuals_); }),
              HasSubstr("its residuals have nan"));
  objective_.count_is = -1;
  EXPECT_THAT(error([&] { term.residual_count(); }), HasSubstr("has -1 residuals, expected 0 to"));
}

TEST_F(InterfaceChecks, SlopesAndJacobiansAreFiniteAndOfTheirSize) {
  const ResidualTerm& term = *objective_.residual_term();
  Jacobian jacobian = Jacobian::Zero(2, 7);
  objective_.slope_is = INFINITY;
  EXPECT_THAT(error([&] { term.write_slopes(nothing_, 0, residuals_, slopes_); }),
              HasSubstr("its slopes of residuals have inf in place 0 of 2"));
  EXPECT_THAT(error([&] { term.write_jacobian(nothing_, residuals_, jacobian); }),
              HasSubstr("its Jacobian has inf for residual 1 of 2 and number 2 of 7 of the state"));
  objective_.slope_is = 0;
  objective_.transposes = true;
  EXPECT_THAT(error([&] { term.write_jacobian(nothing_, residuals_, jacobian); }),
              HasSubstr("its Jacobian is 7 x 2, expected 2 x 7"));
}

TEST_F(InterfaceChecks, ExceptionsGetTheLabelIfThereIsOne) {
  objective_.throws = true;
  EXPECT_THAT(error([&] { objective_.prepare({}); }),
              HasSubstr("threw std::runtime_error: no luck"));
  Faulty nested;
  nested.throws = true;
  EXPECT_THROW(nested.prepare({}), std::runtime_error);
}

TEST_F(InterfaceChecks, TimesAreMeasured) {
  const auto times = objective_.times();
  EXPECT_EQ(times->cost.seconds(), 0);
  for (int i = 0; i < 1000; ++i) objective_.residual_term()->write_residuals(nothing_, residuals_);
  EXPECT_GT(times->cost.seconds(), 0);
  EXPECT_EQ(times->prepare.seconds(), 0);
}

}  // namespace
}  // namespace hypotrack::test
