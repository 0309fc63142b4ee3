#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// One setting that a study varies.
struct StudyAxis {
  std::string key;                       ///< as in the study's grid: `optimizer.particles`
  std::string label = {};                ///< short form for people: `particles`
  std::vector<std::string> values = {};  ///< in the grid's order
  bool numeric = false;                  ///< all values are numbers
};

struct StudyScene {
  std::string name;
  std::string label;
};

/// A plot that a study asks for. Empty: not given.
struct PlotRequest {
  std::string kind = {};  ///< curve, success, heatmap, bars, or one of traced_plot()
  std::string x = {}, y = {}, value = {}, color = {}, facet = {};
  std::string title = {}, x_label = {}, y_label = {};
};

/// The share of frames below an error, as a function of the error.
struct SuccessCurve {
  std::vector<double> threshold_mm;
  std::vector<double> share;
};

/// One run: its place in the study and its result.
struct StudyRun {
  std::string id;
  std::filesystem::path directory;
  std::string scene;
  std::map<std::string, std::string> settings;  ///< axis key to value
  long seed = 0;
  bool failed = false;
  std::string message;                      ///< of a failure
  std::string backend;                      ///< of summary.json: what evaluated, and on which GPU
  std::map<std::string, double> metrics;    ///< numbers of metrics.json; NaN where null
  std::map<std::string, double> timing;     ///< fps, evaluations_per_second of summary.json
  std::map<std::string, double> models_mm;  ///< mean error per model
  std::vector<std::pair<std::string, double>> landmarks_mm;  ///< mean error per landmark
  SuccessCurve success;
  /// Hash of all that track.csv says, but for times. Nothing without one.
  std::optional<std::uint64_t> result;

  /// Returns a metric or timing by its name; NaN if the run has none.
  double number(const std::string& name) const;
  /// Returns the run's value on an axis; the scene's name for `scene`, the seed for `seed`.
  std::string on_axis(std::string_view key) const;
};

/// The subject of a report: a study, or a single run as a study of one.
struct StudyData {
  bool is_study = false;
  std::string title;
  std::string about;
  std::vector<StudyScene> scenes;
  std::vector<StudyAxis> axes;
  std::vector<PlotRequest> plots;
  /// Targets of the plots of how searches converge: shares of the cost at the truth above it.
  std::vector<double> tolerances = {0.01, 0.05, 0.2};
  std::string table_per;       ///< axis with a table for each value; empty: one for all
  std::vector<StudyRun> runs;  ///< by scene, then axis by axis, then seed
  std::size_t planned = 0;     ///< number of runs of the complete study

  const StudyAxis* axis(std::string_view key) const;
  /// Returns the label of an axis, `scene` or `seed`.
  std::string axis_label(std::string_view key) const;
  /// Returns the label of a value, which differs from the value for scenes.
  std::string value_label(std::string_view key, const std::string& value) const;
  /// Returns whether the values on an axis are numbers; `seed` is such an axis.
  bool is_numeric(std::string_view key) const;
  /// Returns the values on an axis (or `scene`, `seed`) in the study's order.
  std::vector<std::string> values_of(std::string_view key) const;
};

/// Reads a study folder (study.yaml, runs/*) or a run folder (track.csv, run.yaml). Throws
/// DataError if `directory` is neither or a file in it is damaged, ConfigError on an unreadable
/// study.yaml.
StudyData read_study(const std::filesystem::path& directory);

/// Reads the results of a run folder: metrics.json and summary.json if they exist, failure.json for
/// a run that failed. Throws DataError on damaged files.
void read_results(const std::filesystem::path& directory, StudyRun& run);

/// Reads a finished or failed run of a study: its cell.json and its results.
StudyRun read_study_run(const std::filesystem::path& directory);

/// Returns numbers in one form, so that 0.10 and 0.1 are the same value; other texts unchanged.
std::string canonical_value(const std::string& text);
/// Parses a text as a finite number. Returns false if it is not one.
bool parse_number(std::string_view text, double& number);

}  // namespace internal
}  // namespace hypotrack
