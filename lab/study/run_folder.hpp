#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "base/exported.hpp"
#include "lab/study/file_lock.hpp"
#include "lab/study/plan.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// The failure of a run that left no results.
struct RunFailure {
  std::string message;
  int exit_code = 0;  ///< 128 + signal if a signal ended it, as in shells
};

/// Cost of a run. It differs between runs of the same id, so it is kept apart from the results.
struct RunCost {
  double seconds = 0;
  int threads = 0;
  std::optional<int> gpu = std::nullopt;  ///< number of the GPU that a worker had for it
};

/// The working folder of a run, or a recording, that this process makes, and its lock. Moves to its
/// final place when complete; removed otherwise.
class RunFolder {
 public:
  /// `final` is the folder's final path.
  RunFolder(FileLock lock, std::filesystem::path working, std::filesystem::path final);
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();

  /// Returns the folder into which the run writes.
  const std::filesystem::path& working() const { return working_; }
  /// Returns the file for the run's stdout and stderr.
  std::filesystem::path log() const { return working_ / "log.txt"; }
  /// Returns the lock's descriptor, which the process that writes into working() must inherit.
  int lock_descriptor() const { return lock_.descriptor(); }

  /// Returns true if the run has reported its end, which its exit code alone does not say.
  bool holds_a_complete_run() const;
  /// Moves the folder to its final path, without the log. Throws OutputError.
  void put_into_place();
  /// Completes a successful run and moves it to its final path. Throws OutputError.
  void finish(const Plan& plan, const PlannedRun& run, const RunCost& cost);
  /// Replaces the run's results by a note of the failure, and moves it with the log to its final
  /// path. Throws OutputError.
  void fail(const Plan& plan, const PlannedRun& run, const RunFailure& failure);

 private:
  void rename();
  FileLock lock_;
  std::filesystem::path working_, final_;
};

/// Returns what to do about a damaged file of a run's folder, for a message.
std::string repair_advice(const std::filesystem::path& file);

/// Reads the failure of a run's folder; nothing if it did not fail. Throws DataError if the note is
/// damaged.
std::optional<RunFailure> read_failure(const std::filesystem::path& folder);

}  // namespace internal
}  // namespace hypotrack::study
