#pragma once

#include <cstdint>
#include <memory>

#include "hypotrack/optimizer.hpp"
#include "hypotrack/start_points.hpp"

namespace hypotrack {

struct MultiStartParams {
  ConfigNode optimizer;
  int starts = 4;
  int candidates = 64;
  double spread = 0.5;
  StartParams around;
  int evaluations = 1024;
  void visit(ParamVisitor& v) {
    v("optimizer", optimizer,
      {.help = "the search from each start: {type: ..., its parameters}", .required = true});
    v("starts", starts,
      {.help = "searches, each from one of the best candidates", .min = 1, .max = 1 << 20});
    v("candidates", candidates,
      {.help = "points evaluated together before the searches: the start and samples about it; at "
               "least `starts`",
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

/// Several searches around the region, the best answer of which is kept. The start and samples
/// about it are evaluated in one batch; the best of them are where the searches begin, the best one
/// first. Each gets an equal part of the evaluations and seconds that the ones before it left (at
/// least one evaluation, on where it begins). Search k has seed_of_part(seed, k). To refine the
/// best one further, make this the first stage of a pipeline.
class MultiStart : public Optimizer {
 public:
  /// Throws ConfigError, naming `where`, with more starts than candidates.
  MultiStart(const MultiStartParams& params, std::unique_ptr<Optimizer> optimizer,
             const std::string& where = "multi_start");

  bool needs_residuals() const override { return optimizer_->needs_residuals(); }
  Linearization linearization() const override { return optimizer_->linearization(); }
  std::string needs_device() const override { return optimizer_->needs_device(); }
  std::int64_t default_evaluations() const override { return params_.evaluations; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  MultiStartParams params_;
  std::unique_ptr<Optimizer> optimizer_;
};

}  // namespace hypotrack
