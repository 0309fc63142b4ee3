#pragma once

#include <string>
#include <vector>

#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// Returns the 20 angles of a hand with their anatomical bounds, in the order of the state (after
/// the pose).
const std::vector<Parameter>& hand_angles();

/// Returns the names of the 21 landmarks, in order.
const std::vector<std::string>& hand_landmarks();

/// Returns the flexion that drives the bone whose joint a landmark is (`index_flexion_1` for
/// `index_mcp`). Empty for the wrist and the tips.
std::string driving_flexion(const std::string& landmark);

/// Returns the flexion that drives the last bone before a tip (`index_flexion_3` for `index_tip`);
/// empty for other landmarks.
std::string last_flexion(const std::string& landmark);

}  // namespace hypotrack
