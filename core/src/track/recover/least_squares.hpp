#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/scene.hpp"
#include "track/search/search_space.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A state and its cost.
struct Refined {
  Eigen::VectorXd state;
  double cost = 0;
};

/// Refines states by a few Levenberg-Marquardt steps on the residuals of the prepared frame.
class LeastSquares {
 public:
  /// Moves only the models flagged in `free`. The cost must have residuals. The scene and the
  /// cost must outlive the object.
  LeastSquares(const Scene& scene, Cost& cost, const std::vector<bool>& free);

  /// Refines each of some states of known costs by at most `iterations` steps. The states take
  /// their steps at the same time, in batches; none depends on another.
  void refine(std::span<Refined> states, int iterations);

  /// Returns the number of evaluations so far.
  std::int64_t evaluations() const { return evaluations_; }

 private:
  struct Descent;
  void take_step(std::vector<Descent>& all);
  std::vector<NormalEquations> linearize(std::vector<Descent>& all);
  NormalEquations by_differences(Descent& one);
  Eigen::VectorXd differences(const SearchRegion& region) const;
  Eigen::MatrixXd trials(const Descent& one, const NormalEquations& equations) const;

  Cost& cost_;
  SearchSpace space_;
  Eigen::VectorXd step_;  ///< of the finite differences, 0 where a dimension does not move
  std::int64_t evaluations_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
