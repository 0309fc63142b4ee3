#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "base/open_folder.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/run_folder.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

enum class RunState { missing, ok, failed };

/// The folder of a study's results:
///
///   study.yaml      the study, variant applied
///   plan.txt        the ids of all runs
///   runs/<id>/      finished runs; a failed one has failure.json instead of results
///   recordings/<id>/recording/  sources that the runs share, if the study asks for it
///   .working/<id>/  a run or recording being made, and its lock beside it
///
/// Any number of processes may work on one folder.
class StudyFolder {
 public:
  /// Opens a folder without changing it. Throws OutputError if it belongs to no study, or to
  /// another study (one with a run that is not in the plan).
  StudyFolder(std::filesystem::path folder, const Plan& plan);

  const std::filesystem::path& path() const { return folder_; }
  /// Returns whether a process has begun exactly this plan.
  bool begun() const;
  /// Makes the folder, so that recordings can be made in it. Returns false if it was there before:
  /// somebody else may count on it. Throws OutputError.
  bool open() const;
  /// Opens the folder, writes the plan and removes leftovers of killed processes. Throws
  /// OutputError.
  void begin() const;
  /// Returns whether a process has begun a study here, which others may work on.
  bool has_plan() const;
  /// Removes a folder that open() made, without the work of other processes, unless it has a plan.
  void abandon() const;

  RunState state(const PlannedRun& run) const;
  std::filesystem::path run_path(const PlannedRun& run) const;
  /// Claims a run for this process. Returns nothing if another process has it. Check state()
  /// afterwards: the run may have been finished in between.
  std::optional<RunFolder> claim(const PlannedRun& run) const;
  /// Returns the final folder of a recording.
  std::filesystem::path recording_path(const std::string& id) const;
  std::optional<RunFolder> claim_recording(const std::string& id) const;
  /// Waits for the lock on the tables and takes it.
  FileLock lock() const;

 private:
  void check_same_study() const;
  /// Throws OutputError if the folder was renamed or removed after open().
  void expect_in_place() const;
  std::optional<RunFolder> claim(const std::string& id, const std::filesystem::path& final) const;
  void remove_leftovers() const;
  std::filesystem::path working() const { return folder_ / ".working"; }

  std::filesystem::path folder_;
  const Plan* plan_;
  mutable std::shared_ptr<const OpenFolder> open_;  ///< after open()
};

}  // namespace internal
}  // namespace hypotrack::study
