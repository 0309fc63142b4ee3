#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "output/metrics/reliability.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Predicted uncertainty of runs with ground truth, and their true errors.
struct UncertaintyCalibration {
  Reliability reliability;
  std::map<std::string, std::vector<double>> errors_by_status;  ///< of frames, in metres
};

/// Adds a run, frame by frame. Compares joints.csv with truth_landmarks.csv, and reads
/// uncertainty.csv and the status in track.csv. Leaves out frames without a known error. Throws
/// DataError on missing and damaged files, naming what is missing.
void add_run(const std::filesystem::path& run, UncertaintyCalibration& calibration);

}  // namespace internal
}  // namespace hypotrack
