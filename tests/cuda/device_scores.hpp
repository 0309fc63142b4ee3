#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "cost/cost.hpp"

namespace hypotrack::test {

using MakeObjective = std::function<std::shared_ptr<Objective>()>;

/// 200 states of a scene near where the pairs of observations.hpp look, one per column.
Eigen::MatrixXd scored_states(const Scene& scene);

/// An observation with the same waves of colour in both views, and a foreground of wide stripes.
Observation colored(Observation observation);

/// An observation whose views see a slanted, wavy surface about where scored_states() are, with
/// holes.
Observation with_depth(Observation observation);

Eigen::VectorXd costs_on(Backend backend, const Scene& scene, const Observation& observation,
                         const MakeObjective& make, const Eigen::MatrixXd& states);

/// Residuals (MxN) and costs (N) of states.
struct Residuals {
  Eigen::MatrixXf values;
  Eigen::VectorXd costs;
};
Residuals residuals_of(Cost& cost, const Eigen::MatrixXd& states);

/// Holds the device's residuals of some states to the CPU's, their normal equations to those of the
/// residuals, and all of it to itself, bit by bit. `worst` and `mean`: of the differences of one
/// hypothesis and of all, in the mean over its residuals, beside the largest residual.
void expect_residuals_like_the_cpu(const Scene& scene, const Observation& observation,
                                   const std::vector<ObjectiveTerm>& cpu_terms,
                                   const std::vector<ObjectiveTerm>& gpu_terms,
                                   const Eigen::MatrixXd& states, double worst = 1e-3,
                                   double mean = 5e-5);

/// Holds the device's costs and residuals, if it has some, of scored_states(), with the first of
/// them as the frame's start, to the CPU's, and to themselves, bit by bit. `worst` and `mean`: of
/// the difference, beside the range of the CPU's costs.
void expect_like_the_cpu(const Scene& scene, Observation observation, const MakeObjective& make,
                         double worst = 1e-3, double mean = 5e-5);

}  // namespace hypotrack::test
