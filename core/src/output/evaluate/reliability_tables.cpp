#include "output/evaluate/reliability_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/csv.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/tables.hpp"
#include "output/evaluate/sigma_table.hpp"
#include "output/metrics/landmark_errors.hpp"
#include "output/run_directory.hpp"

namespace hypotrack::internal {
namespace {

namespace fs = std::filesystem;

fs::path table_in(const fs::path& run, const char* name, const char* why_not) {
  const fs::path file = run / name;
  if (fs::exists(file)) return file;
  throw DataError(fmt::format("{}: has no {}; expected a folder of 'hypotrack run'{}", run.string(),
                              name, why_not));
}

std::map<int, Eigen::Matrix3Xd> landmarks_by_frame(const fs::path& file,
                                                   const std::vector<std::string>& names) {
  std::map<int, Eigen::Matrix3Xd> frames;
  for (LandmarkRow& row : read_landmarks(file, names))
    frames.emplace(row.frame, std::move(row.landmarks));
  return frames;
}

std::map<int, std::string> status_by_frame(const fs::path& file) {
  const CsvTable table(file);
  const int frame = table.find("frame"), status = table.find("status");
  if (frame < 0 || status < 0)
    throw DataError(fmt::format("{}: has no column '{}'; expected the table of 'hypotrack run'",
                                file.string(), frame < 0 ? "frame" : "status"));
  std::map<int, std::string> frames;
  for (const CsvTable::Row& row : table.rows())
    frames[table.frame(row, frame)] = row.cells[static_cast<std::size_t>(status)];
  return frames;
}

}  // namespace

void add_run(const fs::path& run, UncertaintyCalibration& calibration) {
  expect_finished_run(run);
  const SigmaTable sigmas(
      table_in(run, "uncertainty.csv", " with uncertainty.enabled, which has ended"));
  const auto estimates = landmarks_by_frame(table_in(run, "joints.csv", ""), sigmas.names());
  const auto truths = landmarks_by_frame(
      table_in(run, "truth_landmarks.csv", " whose source knows the truth"), sigmas.names());
  const auto statuses = status_by_frame(table_in(run, "track.csv", ""));
  const LandmarkLayout layout = landmark_layout(sigmas.names());
  for (const auto& [frame, sigma] : sigmas.by_frame()) {
    const auto estimate = estimates.find(frame), truth = truths.find(frame);
    const auto status = statuses.find(frame);
    if (estimate == estimates.end() || truth == truths.end() || status == statuses.end()) continue;
    if (status->second == "missing") continue;
    const FrameError error = frame_error(layout, estimate->second, truth->second);
    calibration.reliability.add(sigma, error.landmarks);
    if (!std::isnan(error.mean)) calibration.errors_by_status[status->second].push_back(error.mean);
  }
}

}  // namespace hypotrack::internal
