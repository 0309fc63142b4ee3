#pragma once

#include "hypotrack/plugin/plugin.hpp"

namespace hypotrack::test {

/// Evaluates the start and is content.
class OptimizerOfSize : public Optimizer {
 public:
  explicit OptimizerOfSize(std::int64_t size) : size_(size) {}
  std::int64_t default_evaluations() const override { return size_; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget&,
                           std::uint64_t) override {
    Eigen::VectorXd costs(1);
    cost.evaluate(region.start, costs);
    return {region.start, costs[0], 1};
  }

 private:
  std::int64_t size_;
};

}  // namespace hypotrack::test
