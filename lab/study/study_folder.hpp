#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/run_folder.hpp"

namespace hypotrack::study {

enum class RunState { missing, ok, failed };

/// The folder of a study's results:
///
///   study.yaml      the study, variant applied
///   plan.txt        the ids of all runs
///   runs/<id>/      finished runs; a failed one has failure.json instead of results
///   recordings/<id>/recording/  sources that the runs share, where the study wants that
///   .working/<id>/  a run or recording being made, and its lock beside it
///
/// Any number of processes may work on one folder.
class HYPOTRACK_API StudyFolder {
 public:
  /// Looks, but changes nothing. Throws OutputError if the folder is none of a study, or of another
  /// study: one with a run that is not in the plan.
  StudyFolder(std::filesystem::path folder, const Plan& plan);

  const std::filesystem::path& path() const { return folder_; }
  /// Whether a process with this very plan has begun already.
  bool begun() const;
  /// Makes the folder, notes the plan and removes what killed processes left. Throws OutputError.
  void begin() const;

  RunState state(const PlannedRun& run) const;
  std::filesystem::path run_path(const PlannedRun& run) const;
  /// Takes a run in hand; nothing if another process has it. Look at state() again afterwards: it
  /// may have been finished in between.
  std::optional<RunFolder> claim(const PlannedRun& run) const;
  /// The same for recordings.
  std::filesystem::path recording_path(const std::string& id) const;
  std::optional<RunFolder> claim_recording(const std::string& id) const;
  /// Waits for, and holds, the right to write the tables.
  FileLock lock() const;

 private:
  void check_same_study() const;
  std::optional<RunFolder> claim(const std::string& id, const std::filesystem::path& final) const;
  void remove_leftovers() const;
  std::filesystem::path working() const { return folder_ / ".working"; }

  std::filesystem::path folder_;
  const Plan* plan_;
};

}  // namespace hypotrack::study
