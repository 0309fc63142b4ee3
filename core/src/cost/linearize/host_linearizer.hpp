#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Computes normal equations of the terms' residuals. A term gives them by its Jacobian, or by the
/// slopes of its pixels (PixelRows), or by differences. All analytic terms share one drawn
/// hypothesis; for differences of terms that need rendering, neighbours are drawn. The result does
/// not depend on the number of threads.
class HostLinearizer {
 public:
  /// Returns true if the terms are a sum of squares and one that needs rendering has a Jacobian or
  /// slopes, or none needs rendering.
  static bool can_linearize(const std::vector<ObjectiveTerm>& terms);
  /// See ResidualCost::draws_neighbours(); the terms are a sum of squares.
  static bool draws_neighbours(const std::vector<ObjectiveTerm>& terms);

  /// Rows of a tile are summed in this many parts at the same time by default. The number does not
  /// follow that of the threads, as the sums would then depend on it.
  static constexpr int kBands = 8;

  /// The scene must outlive it. It is called in an arena of at most `threads` slots. Fewer `bands`
  /// take less time in all, and leave less to do at the same time.
  HostLinearizer(const Scene& scene, const std::vector<ObjectiveTerm>& terms, int threads,
                 int bands = kBands);
  ~HostLinearizer();

  /// Sets the cameras of a frame's tiles. The terms must be prepared for that frame.
  void prepare(const Observation& observation);

  /// Computes the normal equations as ResidualCost::linearize(), for normalised states.
  NormalEquations linearize(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                            double blur);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace internal
}  // namespace hypotrack
