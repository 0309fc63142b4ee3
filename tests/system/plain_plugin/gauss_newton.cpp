#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/plugin.hpp"

/// Gauss-Newton steps, halved until they lower the cost, by the helpers of the public headers.
class GaussNewton final : public hypotrack::Optimizer {
 public:
  struct Params {
    hypotrack::LinearizationParams linearization;
    void visit(hypotrack::ParamVisitor& v) { linearization.visit(v); }
  };

  explicit GaussNewton(const Params& params) : params_(params) {}

  hypotrack::Requirements requirements() const override { return {.least_squares = true}; }
  std::int64_t default_evaluations() const override { return 100; }

  hypotrack::OptimizerResult minimize(hypotrack::CostFunction& cost,
                                      const hypotrack::SearchRegion& region,
                                      const hypotrack::Budget& budget,
                                      std::uint64_t /*seed*/) override {
    hypotrack::check_search(cost, region, budget);
    const hypotrack::Deadline deadline(budget.seconds);
    hypotrack::BestSoFar best;
    hypotrack::Linearizer linearizer(cost, region, params_.linearization, best);
    double here = linearizer.evaluate(region.start);
    double length = 1;
    const auto left = [&] { return budget.evaluations - best.result().evaluations; };
    while (std::isfinite(here) && length > 1e-3 && left() > linearizer.price() &&
           !deadline.passed()) {
      const Eigen::VectorXd from = linearizer.point();
      const auto [a, g] = linearizer.equations();
      const Eigen::MatrixXd damped =
          a + Eigen::MatrixXd::Identity(g.size(), g.size()) * (1e-6 + 1e-3 * a.diagonal().mean());
      const Eigen::VectorXd step = length * region.spread.cwiseProduct(-damped.inverse() * g);
      const double there = linearizer.evaluate(hypotrack::within_bounds(from + step, region));
      length = there < here ? 1 : length / 2;
      here = there;
    }
    return best.result();
  }

 private:
  const Params params_;
};

HYPOTRACK_PLUGIN(GaussNewton, "Gauss-Newton steps", "least_squares")
