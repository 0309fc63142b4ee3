#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>

#include "evaluate/evaluator.hpp"

namespace hypotrack::test {

using MakeObjective = std::function<std::shared_ptr<Objective>()>;

/// 200 states of a scene near where the pairs of observations.hpp look, one per column.
Eigen::MatrixXd scored_states(const Scene& scene);

/// An observation with the same waves of colour in both views, and a foreground of wide stripes.
Observation colored(Observation observation);

Eigen::VectorXd costs_on(Backend backend, const Scene& scene, const Observation& observation,
                         const MakeObjective& make, const Eigen::MatrixXd& states);

/// Holds the device's costs of scored_states(), with the first of them as the frame's start, to the
/// CPU's, and to themselves, bit by bit. `worst` and `mean`: of the difference, beside the range of
/// the CPU's costs.
void expect_like_the_cpu(const Scene& scene, Observation observation, const MakeObjective& make,
                         double worst = 1e-3, double mean = 5e-5);

}  // namespace hypotrack::test
