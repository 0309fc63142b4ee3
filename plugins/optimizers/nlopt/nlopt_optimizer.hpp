#pragma once

#include <cstdint>
#include <string>

#include "algorithms.hpp"
#include "hypotrack/plugin/linearization.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {

class ScaledProblem;

struct NloptParams {
  std::string algorithm = "SBPLX";
  int evaluations = 1024;
  std::string local = "SBPLX";
  double step = 0.5;
  double box = 1.0;
  int population = 0;
  double tolerance = 1e-4;
  LinearizationParams gradient;
  void visit(ParamVisitor& v) {
    v("algorithm", algorithm,
      {.help =
           "SBPLX, NELDERMEAD, COBYLA, BOBYQA, PRAXIS (local), LBFGS, VAR1, VAR2, TNEWTON, "
           "TNEWTON_RESTART, TNEWTON_PRECOND, TNEWTON_PRECOND_RESTART, SLSQP, MMA, CCSAQ (local, "
           "by gradients of residuals), CRS2_LM, ESCH, ISRES, DIRECT, DIRECT_L, DIRECT_L_RAND, "
           "ORIG_DIRECT_L or MLSL_LDS (global)"});
    v("evaluations", evaluations,
      {.help = "evaluations where the scene names no budget", .min = 1, .max = 1 << 30});
    v("local", local, {.help = "local searches of MLSL_LDS: any local algorithm but PRAXIS"});
    v("step", step,
      {.help = "first step of local algorithms, as a share of the search region's spread",
       .min = 1e-6,
       .max = 10});
    v("box", box,
      {.help = "how far from the start global algorithms look, in spreads, within the bounds",
       .min = 1e-3,
       .max = 1000});
    v("population", population,
      {.help =
           "population of CRS2_LM (above the number of dimensions), ISRES and ESCH, samples per "
           "iteration of MLSL_LDS; 0: from the budget",
       .min = 0,
       .max = 1 << 20});
    v("tolerance", tolerance,
      {.help = "a local search ends where its step falls below this share of the spread; 0: never",
       .min = 0,
       .max = 1});
    gradient.visit(v);
  }
};

/// Algorithms of NLopt (Steven G. Johnson, https://nlopt.readthedocs.io), one point at a time.
///
/// They search in offsets from the start in units of the region's spread, so that one step fits all
/// dimensions. The start is evaluated first, also if the algorithm begins elsewhere (DIRECT).
/// Global algorithms search the box start +- box * spread within the bounds. PRAXIS has no bounds:
/// its points are clamped before they are evaluated, so the cost is constant beyond a bound. An
/// infeasible (+inf) cost becomes a finite penalty worse than all costs so far.
///
/// LBFGS, VAR, TNEWTON, SLSQP, MMA and CCSAQ follow the gradient 2 J^T r of the residuals. It takes
/// one evaluation where the cost can be linearised, otherwise one per dimension.
///
/// This class, not NLopt, keeps the budget and the best of all evaluated points. A search that ends
/// before its budget (converged, flat objective) is a success.
class Nlopt : public Optimizer {
 public:
  /// `where` is the place of the parameters in messages. Throws ConfigError on algorithms that are
  /// unknown or refused.
  explicit Nlopt(const NloptParams& params, const std::string& where = "nlopt");

  /// Returns least squares for algorithms that use gradients.
  Requirements requirements() const override;
  std::int64_t default_evaluations() const override { return params_.evaluations; }
  /// Searches the region. Throws ConfigError if the cost lacks the requirements, if a DIRECT
  /// algorithm would need more than about 1 GiB, or if the population of CRS2_LM does not exceed
  /// the number of dimensions.
  OptimizerResult minimize(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                           std::uint64_t seed) override;

 private:
  bool uses_gradient() const;
  void check(const ScaledProblem& problem) const;
  void run(ScaledProblem& problem) const;
  OptimizerResult search(CostFunction& cost, const SearchRegion& region, const Budget& budget,
                         std::uint64_t seed) const;

  NloptParams params_;
  std::string where_;
  const NloptAlgorithm* algorithm_;
  const NloptAlgorithm* local_;
};

}  // namespace hypotrack
