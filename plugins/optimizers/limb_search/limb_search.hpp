#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

struct LimbSearchParams {
  ConfigNode optimizer;
  int samples = 16;
  double spread = 2;
  double gain = 0;
  int evaluations = 512;
  void visit(ParamVisitor& v) {
    v("optimizer", optimizer,
      {.help = "the search of one limb from its best sample: {type: ..., its parameters}",
       .required = true});
    v("samples", samples,
      {.help = "places tried for each limb, all over its bounds", .min = 1, .max = 1 << 16});
    v("spread", spread,
      {.help = "factor of the search region's spread in the searches of limbs",
       .min = 1e-3,
       .max = 1e3});
    v("gain", gain,
      {.help = "a limb moves only if that lowers the cost by more than this share; hidden limbs "
               "would otherwise jump for negligible gains",
       .min = 0,
       .max = 1});
    v("evaluations", evaluations,
      {.help = "evaluations where the scene names no budget", .min = 1, .max = 1 << 30});
  }
};

/// Searches each limb of the region (SearchGroup) again over its whole bounds while everything else
/// stays. A finger that was hidden and reappears elsewhere is too far for a search around the last
/// solution, but has few dimensions.
///
/// Evaluates the start and `samples` places of every limb, uniform within its bounds, in one batch;
/// fewer of each if the budget is too small. Then searches all limbs at the same time
/// (Optimizer::minimize_each), each from its best sample, in its own dimensions, with an equal part
/// of the evaluations that are left. Last, it joins the limbs that gained, the best first, each if
/// that lowers the cost. A region without limbs of finite bounds is evaluated at
/// its start only.
///
/// An invisible limb costs about the same everywhere, and among many places one is always a little
/// cheaper. With a `gain` a limb moves only if that lowers the cost by more than this share of its
/// magnitude. The result may then cost a little more than the best point evaluated.
class LimbSearch : public Optimizer {
 public:
  LimbSearch(const LimbSearchParams& params, std::unique_ptr<Optimizer> optimizer)
      : params_(params), optimizer_(std::move(optimizer)) {}

  Requirements requirements() const override { return optimizer_->requirements(); }
  std::int64_t default_evaluations() const override { return params_.evaluations; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  LimbSearchParams params_;
  std::unique_ptr<Optimizer> optimizer_;
};

}  // namespace hypotrack
