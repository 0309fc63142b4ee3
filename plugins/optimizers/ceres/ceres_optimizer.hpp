#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

/// How Ceres limits the steps of Gauss and Newton.
enum class TrustRegion { levenberg_marquardt, dogleg, subspace_dogleg };
std::span<const std::string_view> enum_names(TrustRegion);

struct CeresParams {
  TrustRegion strategy = TrustRegion::levenberg_marquardt;
  int evaluations = 512;
  double radius = 10;
  double tolerance = 1e-4;
  LinearizationParams linearization;
  void visit(ParamVisitor& v) {
    v("strategy", strategy,
      {.help =
           "how steps are limited: by damping (Levenberg and Marquardt), on Powell's dogleg, or "
           "in the plane of its two directions"});
    v("evaluations", evaluations,
      {.help = "evaluations where the scene names no budget", .min = 1, .max = 1 << 30});
    v("radius", radius,
      {.help = "the first radius of the trust region; for levenberg_marquardt 1 / damping",
       .min = 1e-9,
       .max = 1e9});
    v("tolerance", tolerance,
      {.help = "the search ends where its step is shorter than this share of the spread; 0: never",
       .min = 0,
       .max = 1});
    linearization.visit(v);
  }
};

/// The trust-region methods of Ceres Solver (S. Agarwal, K. Mierle and others,
/// http://ceres-solver.org) as a reference for levenberg_marquardt: one step at a time.
///
/// Ceres sees offsets from the start in units of the region's spread, and keeps the bounds by its
/// own projection and line search. It gets the residuals of reduce() instead of those of all
/// pixels; both have the same steps. Jacobians are those of Linearizer.
class CeresOptimizer : public Optimizer {
 public:
  explicit CeresOptimizer(const CeresParams& params) : params_(params) {}

  Requirements requirements() const override {
    return {.least_squares = true, .jacobian = Linearization::welcome};
  }
  std::int64_t default_evaluations() const override { return params_.evaluations; }
  /// Searches the region. Throws ConfigError if the cost lacks the requirements.
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  CeresParams params_;
};

}  // namespace hypotrack
