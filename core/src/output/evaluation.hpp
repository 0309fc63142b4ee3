#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "output/metrics/metrics.hpp"

namespace hypotrack {

/// What is judged, and by what.
struct EvaluationInput {
  /// A folder of `hypotrack run` (its joints.csv, and track.csv for what the tracker said of each
  /// frame), or a table of landmarks (tables.hpp) from any other tracker.
  std::filesystem::path run;
  /// A folder with truth_landmarks.csv (a recording or a run), or a table of landmarks; nothing:
  /// the truth in the folder of the run.
  std::optional<std::filesystem::path> truth;
  double run_metres_per_unit = 1;
  double truth_metres_per_unit = 1;
  std::vector<std::string> rename;  ///< for the run's table, as in LandmarkTableOptions
};

struct Evaluation {
  std::filesystem::path run_table, truth_table;
  Metrics metrics;
};

/// Matches the tables frame by frame, from the first to the last frame of the run; frames of the
/// truth in between that the run has no row for are missing. A landmark of the run that the truth
/// does not have is an error, one that only the truth has is unknown. Throws DataError on missing
/// and damaged files, unknown landmarks, no frame or landmark in common, and tables in different
/// units.
HYPOTRACK_API Evaluation evaluate(const EvaluationInput& input);

}  // namespace hypotrack
