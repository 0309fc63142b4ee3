#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "output/metrics/metrics.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Tables to compare, and their units.
struct EvaluationInput {
  /// A folder of `hypotrack run`, with joints.csv and, for the statuses, track.csv; or a table of
  /// landmarks (tables.hpp) of any other tracker.
  std::filesystem::path run;
  /// A folder with truth_landmarks.csv (a recording or a run), or a table of landmarks. Nothing:
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

/// Compares the tables frame by frame, from the first to the last frame of the run. Frames that
/// only the truth has are missing; landmarks that only the truth has are unknown. Throws DataError
/// on missing, damaged and cut files, landmarks that only the run has, no frame or landmark in
/// common, and tables in different units.
Evaluation evaluate(const EvaluationInput& input);

/// Throws DataError unless a table of a run has one row for each frame that its summary.json
/// counts. Tables without a summary beside them, of other trackers, pass.
void expect_row_per_frame(const std::filesystem::path& table, std::size_t rows);

}  // namespace internal
}  // namespace hypotrack
