#pragma once

#include <vector>

#include "hand_detection.hpp"

namespace hypotrack::hands {

/// Adds a hand. If it is one that is already there, the surer of the two stays, at its place.
void add_or_merge(std::vector<HandDetection>& hands, const HandDetection& hand);

}  // namespace hypotrack::hands
