#pragma once

#include <optional>
#include <vector>

#include "setting.hpp"

// The contract of an objective's residuals. Each check throws Violation, or Skipped where the
// objective does not offer what it checks.

namespace hypotrack::contract {

/// Checks that residuals are finite, that all of them are written and no more, and that threads do
/// not disturb one another.
void check_residuals(const Setting& setting);
/// Checks that cost_and_residuals() gives the cost and the residuals.
void check_cost_and_residuals(const Setting& setting);
/// Returns how much the sum of squares changes with the cost from state to state of the scene, by
/// least squares; nothing if the costs hardly differ.
std::optional<double> rate_of_squares(const Setting& setting);
/// Checks that the median of these rates is near 1. Single ones may differ: on observations of
/// noise, residuals that only stand in for a cost do not follow it.
void check_rates(std::vector<double> rates);
/// Checks the slopes of pixels' residuals.
void check_slopes(const Setting& setting);
/// Checks the Jacobians of hypotheses.
void check_jacobians(const Setting& setting);

}  // namespace hypotrack::contract
