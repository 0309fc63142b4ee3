#pragma once

#include <string>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::contract {

/// Checks an objective's Jacobian of a hypothesis: its size, its numbers and the residuals with it.
/// If the objective needs no rendering, compares it with differences of residuals. Throws
/// Violation, which names the residual and the parameter.
void check_jacobian(const Objective& objective, const Scene& scene,
                    const RenderedHypothesis& hypothesis, const std::string& where);

}  // namespace hypotrack::contract
