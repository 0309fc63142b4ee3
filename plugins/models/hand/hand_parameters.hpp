#pragma once

#include <string>
#include <vector>

#include "hypotrack/model.hpp"

namespace hypotrack {

/// The 20 angles of a hand with their anatomical bounds, in the order of the state (after the
/// pose).
const std::vector<Parameter>& hand_angles();

/// The names of the 21 landmarks, in order.
const std::vector<std::string>& hand_landmarks();

/// The bone whose joint a landmark is, by the flexion that drives it (`index_flexion_1` for
/// `index_mcp`); empty for the wrist and the tips.
std::string driving_flexion(const std::string& landmark);

/// The flexion that drives the last bone before a tip (`index_flexion_3` for `index_tip`); empty
/// for everything else.
std::string last_flexion(const std::string& landmark);

}  // namespace hypotrack
