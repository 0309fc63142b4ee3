#include "ceres_optimizer.hpp"
#include "hypotrack/plugin/plugin.hpp"

namespace {

class CeresPlugin final : public hypotrack::CeresOptimizer {
 public:
  using Params = hypotrack::CeresParams;
  using CeresOptimizer::CeresOptimizer;
};

}  // namespace

HYPOTRACK_PLUGIN(CeresPlugin,
                 "trust-region methods of Ceres Solver on the residuals: Levenberg-Marquardt, "
                 "dogleg",
                 "needs_least_squares")
