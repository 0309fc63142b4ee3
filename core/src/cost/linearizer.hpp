#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/observation.hpp"
#include "hypotrack/optimizer.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// Normal equations of the terms' residuals from one drawn hypothesis: pixels by PixelRows, terms
/// that need no rendering by differences. The same whatever the number of threads.
class Linearizer {
 public:
  /// Whether every term of a sum of squares has what it takes.
  static bool can_linearize(const std::vector<ObjectiveTerm>& terms);

  /// The scene must outlive it. `threads`: 0 for one per core.
  Linearizer(const Scene& scene, const std::vector<ObjectiveTerm>& terms, int threads);
  ~Linearizer();

  /// Takes the cameras of a frame's tiles, for which the terms are prepared.
  void prepare(const Observation& observation);

  /// See ResidualCost::linearize; states (normalised) in place of points.
  NormalEquations linearize(const Eigen::MatrixXd& states, const Eigen::VectorXd& steps,
                            double blur);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
