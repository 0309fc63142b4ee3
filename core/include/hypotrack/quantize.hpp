#pragma once

#include <cmath>

namespace hypotrack {

/// Quantises a setting that follows recent frames to the nearest power of 1.1; `value` > 0. A
/// quantised setting rarely changes. So costs of successive frames stay comparable, and CUDA graphs
/// of a search are rarely recaptured.
inline double quantize_log(double value) {
  constexpr double kStep = 1.1;
  return std::pow(kStep, std::round(std::log(value) / std::log(kStep)));
}

}  // namespace hypotrack
