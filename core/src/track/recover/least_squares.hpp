#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/scene.hpp"
#include "track/search_space.hpp"

namespace hypotrack {

/// A state, its cost and what that took.
struct Refined {
  Eigen::VectorXd state;
  double cost = 0;
  std::int64_t evaluations = 0;
};

/// Refines states by a few steps of Levenberg and Marquardt on the residuals of a prepared frame.
class LeastSquares {
 public:
  /// Moves only the models of which `free` is true. The scene and the evaluator, which has
  /// residuals, must outlive it.
  LeastSquares(const Scene& scene, Evaluator& evaluator, const std::vector<bool>& free);

  /// Refines a state of a known cost by at most `iterations` steps.
  Refined refine(Refined from, int iterations);

 private:
  NormalEquations linearize(const SearchRegion& region, const Eigen::VectorXd& prior,
                            Refined& state);

  Evaluator& evaluator_;
  SearchSpace space_;
  Eigen::VectorXd step_;  ///< of differences, 0 where a dimension does not move
};

}  // namespace hypotrack
