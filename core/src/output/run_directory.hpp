#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "base/open_folder.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns whether a file's name is that of a result. A # in the latter stands for any number.
bool is_result(std::string_view name, std::string_view result);

/// The last file of a run: it says, by being there, that the run is finished.
inline constexpr const char* kSummaryFile = "summary.json";

/// Throws DataError if a folder holds a run without its last file: the run goes on,
/// or was killed.
void expect_finished_run(const std::filesystem::path& folder);

/// The folder of a run's results. Files have their names from the start and may be read while they
/// grow. The last result appears when all others are complete: with it, a run is finished. Results
/// of an earlier run are kept in the folder `.previous` until then. The folder may be renamed while
/// the run goes on.
class RunDirectory {
 public:
  /// Makes the folder if needed, sets the results of an earlier run aside, and removes those of a
  /// killed run that began after it. `results` are the names that a run may write; a # in one
  /// stands for any number ("worst_#.jpg"). Every run writes the first of them at its start and the
  /// last at its end. Throws OutputError in three cases: the folder cannot be made or written;
  /// another run is writing there; a folder, or a file that no run wrote, has the name of a result.
  RunDirectory(std::filesystem::path directory, std::vector<std::string> results);

  /// Removes the files of this run and puts the earlier ones back, unless keep() was called.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const OpenFolder& folder() const { return *folder_; }

  /// Returns the path at which to write the file `name`, the same for every call. It is for this
  /// process; messages show OpenFolder::shown() of it. May be called from several threads.
  std::filesystem::path file(const std::string& name);

  /// Keeps the files from now on, whatever happens.
  void keep() { keep_ = true; }

  /// Gives the last result its name and removes the results of the earlier run. Throws OutputError,
  /// also if the folder was removed.
  void finish();

 private:
  /// Makes and opens the folder. Throws OutputError.
  void open();
  std::filesystem::path path_of(const std::string& name) const;
  /// Returns the names of results in a folder.
  std::vector<std::string> results_in(const std::filesystem::path& folder) const;
  /// Throws OutputError if the folder is not a run's but has files with names of results, such as
  /// the truth of a recording.
  void spare_foreign_files() const;
  /// Locks the folder for the life of the object. Throws OutputError if another run holds the lock.
  void lock() const;
  /// Moves the results in the folder to `.previous`.
  void set_aside();
  /// Moves what set_aside() moved back.
  void put_back();
  void put_back_moved();
  /// Moves files from a folder to another one, which it makes. Throws OutputError.
  static void move_all(const std::filesystem::path& from, const std::filesystem::path& to,
                       const std::vector<std::string>& names);

  std::filesystem::path given_;       ///< name of the folder
  std::optional<OpenFolder> folder_;  ///< is there after open()
  std::filesystem::path directory_;   ///< path of the open folder
  std::filesystem::path previous_;    ///< results of the earlier run
  std::filesystem::path moving_;      ///< the same, while they are moved
  std::vector<std::string> results_;
  std::mutex mutex_;                ///< guards the names
  std::vector<std::string> names_;  ///< of the files of this run
  bool made_ = false;
  std::atomic<bool> keep_ = false;
};

}  // namespace internal
}  // namespace hypotrack
