#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "output/metrics/reliability.hpp"

namespace hypotrack {

/// What runs with ground truth said of their own errors, and what these were.
struct SelfJudgement {
  Reliability reliability;
  std::map<std::string, std::vector<double>> errors_by_status;  ///< of frames, in metres
};

/// Adds a run, frame by frame: uncertainty.csv and the status in track.csv beside joints.csv
/// against truth_landmarks.csv. Frames without a known error are left out. Throws DataError on
/// missing and damaged files, naming what is missing.
HYPOTRACK_API void add_run(const std::filesystem::path& run, SelfJudgement& judgement);

}  // namespace hypotrack
