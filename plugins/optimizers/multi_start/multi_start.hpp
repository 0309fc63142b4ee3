#pragma once

#include <cstdint>
#include <memory>

#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/start_points.hpp"

namespace hypotrack {

struct MultiStartParams {
  ConfigNode optimizer;
  int restarts = 4;
  int candidates = 64;
  double spread = 0.5;
  StartParams around;
  int evaluations = 1024;
  void visit(ParamVisitor& v) {
    v("optimizer", optimizer,
      {.help = "the search from each start: {type: ..., its parameters}", .required = true});
    v("restarts", restarts,
      {.help = "searches, each from one of the best candidates", .min = 1, .max = 1 << 20});
    v("candidates", candidates,
      {.help = "points evaluated together before the searches: the start and samples about it; at "
               "least `restarts`",
       .min = 1,
       .max = 1 << 20});
    v("spread", spread,
      {.help = "factor of the search region's spread in the searches", .min = 1e-3, .max = 1e3});
    around.visit(v);
    v("evaluations", evaluations,
      {.help = "evaluations of all searches where the scene names no budget",
       .min = 1,
       .max = 1 << 30});
  }
};

/// Runs several searches around the region and keeps the best result. Evaluates the start and
/// samples around it in one batch. The searches begin at the best of these and run at the same time
/// where the optimizer can (Optimizer::minimize_each). Each has an equal part of the evaluations
/// that are left. To refine the result, make this the first stage of a
/// pipeline.
class MultiStart : public Optimizer {
 public:
  /// Throws ConfigError, naming `where`, if there are more restarts than candidates.
  MultiStart(const MultiStartParams& params, std::unique_ptr<Optimizer> optimizer,
             const std::string& where = "multi_start");

  Requirements requirements() const override { return optimizer_->requirements(); }
  std::int64_t default_evaluations() const override { return params_.evaluations; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  MultiStartParams params_;
  std::unique_ptr<Optimizer> optimizer_;
};

}  // namespace hypotrack
