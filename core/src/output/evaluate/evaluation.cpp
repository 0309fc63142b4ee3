#include "output/evaluate/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "base/csv.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/tables.hpp"
#include "output/evaluate/sigma_table.hpp"
#include "output/evaluate/true_landmarks.hpp"
#include "output/run_directory.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kOtherUnits = 30;  // errors are never that large, and units differ by 10 at least

fs::path run_table(const fs::path& run) {
  if (!fs::exists(run))
    throw DataError(
        fmt::format("{}: is missing; expected a folder of 'hypotrack run' or a table of landmarks",
                    run.string()));
  if (!fs::is_directory(run)) return run;
  expect_finished_run(run);
  const fs::path table = run / "joints.csv";
  if (fs::exists(table)) return table;
  throw DataError(fmt::format(
      "{}: has no joints.csv; expected a folder of 'hypotrack run' or a table of landmarks",
      run.string()));
}

fs::path truth_table(const EvaluationInput& input) {
  if (!input.truth && !fs::is_directory(input.run))
    throw DataError(
        fmt::format("{}: a table of landmarks brings no truth of its own; name one with --truth",
                    input.run.string()));
  const fs::path& truth = input.truth ? *input.truth : input.run;
  if (!fs::exists(truth))
    throw DataError(fmt::format(
        "{}: is missing; expected a recording, a run with ground truth or a table of landmarks",
        truth.string()));
  if (!fs::is_directory(truth)) return truth;
  expect_finished_run(truth);
  const fs::path table = truth / "truth_landmarks.csv";
  if (fs::exists(table)) return table;
  throw DataError(fmt::format(
      "{}: has no truth_landmarks.csv; {}", truth.string(),
      input.truth ? "expected a recording, a run with ground truth or a table of landmarks"
                  : "the run's source knew no truth: name one with --truth"));
}

/// Returns the landmarks that a table has columns for.
std::vector<std::string> landmarks_in(const fs::path& file) {
  const CsvTable table(file);
  std::vector<std::string> names;
  for (const std::string_view column : table.columns()) {
    if (!column.ends_with("_x")) continue;
    const std::string base(column.substr(0, column.size() - 2));
    if (table.find(base + "_y") >= 0 && table.find(base + "_z") >= 0) names.push_back(base);
  }
  if (names.empty())
    throw DataError(
        fmt::format("{}: has no landmark; expected frame, time and columns <landmark>_x, _y and _z",
                    file.string()));
  return names;
}

/// Returns the truth's landmarks under their full names. One without a model gets the model of the
/// one landmark of the run with that name.
std::vector<std::string> full_names(std::vector<std::string> names,
                                    const std::vector<std::string>& of_run) {
  for (std::string& name : names) {
    if (name.find('.') != std::string::npos) continue;
    const auto is_it = [ending = "." + name](const std::string& other) {
      return other.ends_with(ending);
    };
    if (std::count_if(of_run.begin(), of_run.end(), is_it) == 1)
      name = *std::find_if(of_run.begin(), of_run.end(), is_it);
  }
  return names;
}

FrameStatus status_of(const CsvTable& table, const CsvTable::Row& row, int column) {
  const std::string_view status = row.cells[static_cast<std::size_t>(column)];
  if (const auto named = status_named(status)) return *named;
  throw DataError(
      fmt::format("{}: the status is '{}'; expected tracked, uncertain, lost, absent or missing",
                  table.where(row), status));
}

/// Reads the tracker's status of each frame; empty for a table from elsewhere.
std::map<int, FrameStatuses> read_statuses(const fs::path& run,
                                           const std::vector<std::string>& models) {
  std::map<int, FrameStatuses> statuses;
  if (!fs::is_directory(run) || !fs::exists(run / "track.csv")) return statuses;
  const CsvTable table(run / "track.csv");
  expect_row_per_frame(run / "track.csv", table.rows().size());
  const int frame = table.find("frame"), status = table.find("status");
  if (frame < 0 || status < 0)
    throw DataError(fmt::format("{}: has no column '{}'; expected the table of 'hypotrack run'",
                                (run / "track.csv").string(), frame < 0 ? "frame" : "status"));
  std::vector<int> columns;
  for (const std::string& model : models) columns.push_back(table.find(model + ".status"));
  const bool by_model = std::ranges::find(columns, -1) == columns.end();
  for (const CsvTable::Row& row : table.rows()) {
    FrameStatuses& of_frame = statuses[table.frame(row, frame)];
    of_frame.frame = status_of(table, row, status);
    if (!by_model) continue;
    for (const int column : columns) of_frame.models.push_back(status_of(table, row, column));
  }
  return statuses;
}

/// Reads the tracker's sigma of each landmark; empty if there is none.
std::map<int, Eigen::VectorXd> read_sigmas(const fs::path& run,
                                           const std::vector<std::string>& names) {
  if (!fs::is_directory(run) || !fs::exists(run / "uncertainty.csv")) return {};
  const SigmaTable table(run / "uncertainty.csv");
  if (table.names() != names) return {};  // sigmas of other landmarks than compared
  return table.by_frame();
}

/// Reads the outcome of each frame of a traced run, by the run's own truth; empty for others.
std::map<int, FrameOutcome> read_outcomes(const EvaluationInput& input) {
  std::map<int, FrameOutcome> outcomes;
  const fs::path file = input.run / "truth_costs.csv";
  if (input.truth || !fs::exists(file)) return outcomes;
  const CsvTable table(file);
  const int frame = table.find("frame"), outcome = table.find("outcome");
  if (frame < 0 || outcome < 0)
    throw DataError(fmt::format("{}: has no column '{}'; expected the table of 'hypotrack run'",
                                file.string(), frame < 0 ? "frame" : "outcome"));
  for (const CsvTable::Row& row : table.rows())
    outcomes[table.frame(row, frame)] = outcome_in(table, row, outcome);
  return outcomes;
}

/// One table of the comparison, by frame.
class Side {
 public:
  Side(const fs::path& file, const std::vector<std::string>& names,
       const LandmarkTableOptions& options)
      : file_(file.string()) {
    std::vector<LandmarkRow> rows = read_landmarks(file, names, options);
    if (rows.empty()) throw DataError(fmt::format("{}: has no rows", file_));
    for (LandmarkRow& row : rows) {
      has_times_ = has_times_ || row.time != 0;
      rows_.emplace(row.frame, std::move(row));
    }
  }

  const std::string& file() const { return file_; }
  const std::map<int, LandmarkRow>& rows() const { return rows_; }
  const LandmarkRow* find(int frame) const {
    const auto it = rows_.find(frame);
    return it == rows_.end() ? nullptr : &it->second;
  }
  /// Returns the time of a frame; NaN if unknown.
  double time(int frame) const {
    const LandmarkRow* row = has_times_ ? find(frame) : nullptr;
    return row == nullptr ? kNan : row->time;
  }
  std::string frames() const {
    return fmt::format("frames {} to {}", rows_.begin()->first, rows_.rbegin()->first);
  }
  /// Returns the median distance of the landmarks from the origin; NaN without any.
  double distance() const {
    std::vector<double> distances;
    for (const auto& [frame, row] : rows_)
      for (const double distance : row.landmarks.colwise().norm()) distances.push_back(distance);
    return percentile(without_nan(distances), 0.5);
  }

 private:
  std::string file_;
  std::map<int, LandmarkRow> rows_;
  bool has_times_ = false;
};

/// Throws DataError if a table of a run's folder has fewer or more rows than the run wrote.
void check_rows(const EvaluationInput& input, const Side& run, const Side& truth) {
  if (fs::is_directory(input.run)) expect_row_per_frame(run.file(), run.rows().size());
  const fs::path errors = fs::path(truth.file()).parent_path() / "errors.csv";
  if (!fs::is_directory(input.truth.value_or(input.run)) || !fs::exists(errors)) return;
  const std::size_t expected = CsvTable(errors).rows().size();
  if (truth.rows().size() == expected) return;
  throw DataError(fmt::format(
      "{}: has {} rows, expected {}, as many as {}; make the run again, or copy the whole table",
      truth.file(), truth.rows().size(), expected, errors.string()));
}

void check_units(const Side& run, const Side& truth) {
  const double run_distance = run.distance(), truth_distance = truth.distance();
  const double ratio = run_distance / truth_distance;
  if (!(ratio > kOtherUnits || ratio < 1 / kOtherUnits)) return;  // true for NaN
  throw DataError(fmt::format(
      "{}: its landmarks lie {:.4g} m from the origin, those of {} {:.4g} m; tables are in metres "
      "unless --units (for the run) or --truth-units says otherwise",
      run.file(), run_distance, truth.file(), truth_distance));
}

Metrics compare(const std::vector<std::string>& names, const Side& run, const Side& truth,
                const std::map<int, FrameStatuses>& statuses,
                const std::map<int, Eigen::VectorXd>& sigmas,
                const std::map<int, FrameOutcome>& outcomes) {
  const auto landmarks_count = static_cast<Eigen::Index>(names.size());
  const Eigen::Matrix3Xd nothing = Eigen::Matrix3Xd::Constant(3, landmarks_count, kNan);
  const int first = run.rows().begin()->first, last = run.rows().rbegin()->first;
  std::set<int> frames;
  for (const auto& [frame, row] : run.rows()) frames.insert(frame);
  for (const auto& [frame, row] : truth.rows())
    if (frame >= first && frame <= last) frames.insert(frame);
  const LandmarkLayout layout = landmark_layout(names);
  MetricsCollector collector(layout);
  for (const int frame : frames) {
    const LandmarkRow* estimate = run.find(frame);
    const LandmarkRow* answer = truth.find(frame);
    const auto status = statuses.find(frame);
    const auto sigma = sigmas.find(frame);
    const bool missing = estimate == nullptr || estimate->landmarks.array().isNaN().all();
    const double time = run.time(frame);
    collector.add(frame, std::isnan(time) ? truth.time(frame) : time,
                  missing                    ? FrameStatuses{FrameStatus::missing}
                  : status != statuses.end() ? status->second
                                             : FrameStatuses{},
                  estimate == nullptr ? nothing : estimate->landmarks,
                  answer == nullptr ? Eigen::Matrix3Xd() : answer->landmarks,
                  answer == nullptr ? std::vector<bool>()
                                    : absent_models(*answer, layout.model_of, layout.models.size()),
                  sigma == sigmas.end() ? Eigen::VectorXd() : sigma->second);
    if (const auto outcome = outcomes.find(frame); outcome != outcomes.end())
      collector.add_outcome(outcome->second);
  }
  return collector.metrics();
}

void check_overlap(const Side& run, const Side& truth, const Metrics& metrics) {
  if (metrics.evaluated_frames > 0) return;
  bool common = false, absent = false;
  for (const auto& [frame, row] : run.rows()) {
    const LandmarkRow* answer = truth.find(frame);
    common = common || answer != nullptr;
    absent = absent || (answer != nullptr && !answer->absent.empty());
  }
  if (absent) return;
  if (!common)
    throw DataError(fmt::format(
        "{}: no frame in common with {}: {} against {}; frames are matched by their numbers",
        run.file(), truth.file(), run.frames(), truth.frames()));
  throw DataError(fmt::format(
      "{}: no landmark is known both here and in {} in any frame that they have in common",
      run.file(), truth.file()));
}

}  // namespace

Evaluation evaluate(const EvaluationInput& input) {
  Evaluation evaluation{run_table(input.run), truth_table(input), {}};
  const std::vector<std::string> names =
      full_names(landmarks_in(evaluation.truth_table), landmarks_in(evaluation.run_table));
  const Side truth(evaluation.truth_table, names,
                   {.metres_per_unit = input.truth_metres_per_unit, .rename = {}});
  const Side run(evaluation.run_table, names,
                 {.metres_per_unit = input.run_metres_per_unit,
                  .rename = input.rename,
                  .owner = evaluation.truth_table.string()});
  check_rows(input, run, truth);
  check_units(run, truth);
  evaluation.metrics =
      compare(names, run, truth, read_statuses(input.run, landmark_layout(names).models),
              read_sigmas(input.run, names), read_outcomes(input));
  check_overlap(run, truth, evaluation.metrics);
  return evaluation;
}

}  // namespace hypotrack::internal
