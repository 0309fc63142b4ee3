#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "hypotrack/export.hpp"
#include "lab/study/file_lock.hpp"
#include "lab/study/plan.hpp"

namespace hypotrack::study {

/// How a run ended that left no results.
struct RunFailure {
  std::string message;
  int exit_code = 0;  ///< 128 + signal if a signal ended it, as shells have it
};

/// What a run cost. Not the same twice, so it is kept apart from the results.
struct RunCost {
  double seconds = 0;
  int threads = 0;
};

/// A run, or a recording, that this process makes: it holds its lock and a folder to work in, which
/// becomes the run's folder when all of it is there and goes away otherwise.
class HYPOTRACK_API RunFolder {
 public:
  /// `final` is where the folder will be.
  RunFolder(FileLock lock, std::filesystem::path working, std::filesystem::path final);
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();

  /// Where the run writes.
  const std::filesystem::path& working() const { return working_; }
  /// What the run says.
  std::filesystem::path log() const { return working_ / "log.txt"; }
  /// To be inherited by the process that writes into working().
  int lock_descriptor() const { return lock_.descriptor(); }

  /// Gives the folder its name, without the log. Throws OutputError.
  void put_into_place();
  /// Puts the finished run into place. Throws OutputError.
  void finish(const Plan& plan, const PlannedRun& run, const RunCost& cost);
  /// Puts a note of the failure into place, with the log; results that the run left go. Throws
  /// OutputError.
  void fail(const Plan& plan, const PlannedRun& run, const RunFailure& failure);

 private:
  void rename();
  FileLock lock_;
  std::filesystem::path working_, final_;
};

/// Whether a run's folder holds a failure, and which. Throws DataError if the note is damaged.
std::optional<RunFailure> read_failure(const std::filesystem::path& folder);

/// The line of a log that says why a run failed, without the names of its folders.
HYPOTRACK_API std::string failure_message(const std::filesystem::path& log, int exit_code,
                                          int signal);

}  // namespace hypotrack::study
