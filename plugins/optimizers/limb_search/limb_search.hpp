#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hypotrack/optimizer.hpp"
#include "hypotrack/params.hpp"

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
      {.help = "a limb moves only where that lowers the cost by more than this share of it: a limb "
               "that nothing is seen of gains a little nearly everywhere",
       .min = 0,
       .max = 1});
    v("evaluations", evaluations,
      {.help = "evaluations where the scene names no budget", .min = 1, .max = 1 << 30});
  }
};

/// Looks for each limb of the region (SearchGroup) anew while everything else stays: a finger that
/// was hidden and comes into sight somewhere else is beyond what a search about the last solution
/// finds, and yet it has few numbers.
///
/// The start and `samples` places of every limb, uniform within its bounds, are evaluated in one
/// batch; where the budget does not reach that far, fewer of each. Then each limb is searched from
/// its best sample, within its own dimensions, those of the lowest costs first, and later ones
/// beside what was found before. Each gets an equal part of the evaluations and seconds that those
/// before it left. A region without limbs of finite bounds is evaluated at its start only. Search k
/// has seed_of_part(seed, k).
///
/// A limb of which nothing is seen costs about the same wherever it is, and among many places one
/// is always a little cheaper. With a `gain` a limb stays where it was unless moving it lowers the
/// cost by more than that share of its magnitude; the answer is then the best of those moves and of
/// the start, and may cost a little more than the best point evaluated.
class LimbSearch : public Optimizer {
 public:
  LimbSearch(const LimbSearchParams& params, std::unique_ptr<Optimizer> optimizer)
      : params_(params), optimizer_(std::move(optimizer)) {}

  bool needs_residuals() const override { return optimizer_->needs_residuals(); }
  Linearization linearization() const override { return optimizer_->linearization(); }
  std::string needs_device() const override { return optimizer_->needs_device(); }
  std::int64_t default_evaluations() const override { return params_.evaluations; }
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  LimbSearchParams params_;
  std::unique_ptr<Optimizer> optimizer_;
};

}  // namespace hypotrack
