#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace hypotrack {

/// Returns whether a file's name is that of a result. A # in the latter stands for any number.
bool is_result(std::string_view name, std::string_view result);

/// The folder of a run's results. Files are written under temporary names (`.part.track.csv`) and
/// renamed together when the run ends, so that a file with its final name is complete.
class RunDirectory {
 public:
  /// Makes the folder if needed and removes unfinished files of an earlier, killed run. `results`
  /// are the names that a run may write; a # in one stands for any number ("worst_#.jpg"). Every
  /// run writes the first of them. Throws OutputError in three cases: the folder cannot be made or
  /// written; another run is writing there; a folder, or a file that no run wrote, has the name of
  /// a result.
  RunDirectory(std::filesystem::path directory, std::vector<std::string> results);

  /// Removes the unfinished files, and the folder if it was made here, unless keep() was called.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::filesystem::path& path() const { return directory_; }

  /// Returns the path at which to write the file that will be called `name`, the same for every
  /// call. Keeps a video's suffix. May be called from several threads.
  std::filesystem::path part(const std::string& name);

  /// Keeps unfinished files from now on, whatever happens.
  void keep() { keep_ = true; }

  /// Gives every file of part() its final name, replacing results of an earlier run. Removes
  /// earlier results that this run did not write. Throws OutputError.
  void finish();

 private:
  std::filesystem::path part_path(const std::string& name) const;
  /// Returns the names in the folder that consist of `prefix` and a result's name.
  std::vector<std::string> results_there(const std::string& prefix) const;
  /// Throws OutputError if the folder is not a run's but has files with names of results, such as
  /// the truth of a recording.
  void spare_foreign_files() const;
  /// Locks the folder for the life of the object. Throws OutputError if another run holds the lock.
  void lock();
  std::filesystem::path directory_;
  std::vector<std::string> results_;
  std::mutex mutex_;                ///< guards the names
  std::vector<std::string> names_;  ///< of the files of this run
  bool made_ = false;
  std::atomic<bool> keep_ = false;
  int descriptor_ = -1;  ///< file descriptor of the locked folder
};

}  // namespace hypotrack
