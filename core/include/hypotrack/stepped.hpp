#pragma once

#include <cmath>

namespace hypotrack {

/// The nearest power of 1.1 (`value` > 0): for settings that follow what recent frames have shown.
/// In steps, costs of one frame and the next compare, and searches that were captured into a graph
/// are rarely captured again.
inline double stepped(double value) {
  constexpr double kStep = 1.1;
  return std::pow(kStep, std::round(std::log(value) / std::log(kStep)));
}

}  // namespace hypotrack
