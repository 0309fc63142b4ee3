#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the derivatives of a state (column 0) by the dimensions of its neighbours, which differ
/// by steps[i]; 0 where a step is 0. States are normalised. Derivatives of quaternions stay within
/// the unit sphere.
Eigen::MatrixXd state_derivatives(const Scene& scene, const Eigen::MatrixXd& states,
                                  const Eigen::VectorXd& steps);

/// Adds the normal equations of a term by its write_jacobian(). `derivatives`: of the state. Rows
/// that follow each other and depend on the same models are multiplied within their columns alone:
/// the time of many models rises with their number, and not with its square.
void add_by_jacobian(const Scene& scene, const ObjectiveTerm& term,
                     const RenderedHypothesis& hypothesis, const Eigen::MatrixXd& derivatives,
                     NormalEquations& sums);

/// Adds the normal equations of a term that needs no rendering, by differences between the
/// residuals of a state (column 0) and its neighbours.
void add_by_differences(const ObjectiveTerm& term, const Eigen::MatrixXd& states,
                        const Eigen::VectorXd& steps, NormalEquations& sums);

}  // namespace internal
}  // namespace hypotrack
