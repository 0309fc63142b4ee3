#include "hypotrack/plugin/plugin.hpp"
#include "levenberg_marquardt.hpp"

namespace {

class LevenbergMarquardtPlugin final : public hypotrack::LevenbergMarquardt {
 public:
  using Params = hypotrack::LevenbergMarquardtParams;
  using LevenbergMarquardt::LevenbergMarquardt;
};

}  // namespace

HYPOTRACK_PLUGIN(
    LevenbergMarquardtPlugin,
    "damped least squares (Levenberg 1944, Marquardt 1963) with analytic or numerical Jacobians",
    "batches needs_least_squares")
