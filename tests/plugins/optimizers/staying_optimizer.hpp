#pragma once

#include <cstdint>
#include <vector>

#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack::test {

/// Evaluates its start as often as it may. Notes where it was to search.
class StayingOptimizer final : public Optimizer {
 public:
  explicit StayingOptimizer(std::vector<SearchRegion>& regions) : regions_(regions) {}
  std::int64_t default_evaluations() const override { return 1; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t) override {
    regions_.push_back(region);
    BestSoFar best;
    const Eigen::MatrixXd points = region.start.replicate(1, budget.evaluations);
    Eigen::VectorXd costs(budget.evaluations);
    cost.evaluate(points, costs);
    best.update(points, costs);
    return best.result();
  }

 private:
  std::vector<SearchRegion>& regions_;
};

}  // namespace hypotrack::test
