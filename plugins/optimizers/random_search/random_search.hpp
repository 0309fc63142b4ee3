#pragma once

#include <cstdint>

#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/start_points.hpp"

namespace hypotrack {

struct RandomSearchParams {
  int evaluations = 1024;
  int batch = 256;
  StartParams start;
  void visit(ParamVisitor& v) {
    v("evaluations", evaluations,
      {.help = "samples, the start included, where the scene names no budget",
       .min = 1,
       .max = 1 << 30});
    v("batch", batch, {.help = "samples evaluated together", .min = 1, .max = 1 << 20});
    start.visit(v);
  }
};

/// Random search, the baseline that every optimizer must beat. Samples the start, then normal
/// samples around it with standard deviation sigma * spread, clamped to the bounds, and keeps the
/// best. Sample k is a swarm's initial particle k.
class RandomSearch : public Optimizer {
 public:
  explicit RandomSearch(const RandomSearchParams& params) : params_(params) {}

  std::int64_t default_evaluations() const override { return params_.evaluations; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  RandomSearchParams params_;
};

}  // namespace hypotrack
