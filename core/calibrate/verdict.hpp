#pragma once

#include <string>
#include <vector>

#include "calibrate/stereo_calibration.hpp"

namespace hypotrack::calibrate {

/// What a calibration is worth, in words.
struct Verdict {
  bool usable = true;
  std::string summary;              ///< one sentence
  std::vector<std::string> advice;  ///< what to do for a better one; empty: nothing
};

/// Returns what a calibration from these pairs is worth.
Verdict verdict_of(const std::vector<BoardPair>& pairs, const StereoCalibration& calibration);

}  // namespace hypotrack::calibrate
