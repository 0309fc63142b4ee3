#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// The folder of a run's results. Files grow under a name of their own (`.part.track.csv`) and get
/// their real one all together when the run ends, so that whatever carries a final name is whole.
class HYPOTRACK_API RunDirectory {
 public:
  /// Makes the folder if need be and removes what an earlier, killed run left unfinished. `results`
  /// are the names that a run may write; a # in one stands for any number ("worst_#.jpg"). Every
  /// run writes the first of them. Throws OutputError if the folder cannot be made or written,
  /// another run is writing there, a folder has the name of a result, or files that no run wrote
  /// have.
  RunDirectory(std::filesystem::path directory, std::vector<std::string> results);

  /// Unless keep() was called, removes the unfinished files, and the folder if it was made here.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::filesystem::path& path() const { return directory_; }

  /// Where to write the file that will be called `name`. A video keeps its suffix.
  std::filesystem::path part(const std::string& name);

  /// From now on unfinished files are worth keeping, whatever happens.
  void keep() { keep_ = true; }

  /// Gives every file of part() its final name, replacing what an earlier run left there, and
  /// removes results of an earlier run that this one did not write. Throws OutputError.
  void finish();

 private:
  std::filesystem::path part_path(const std::string& name) const;
  /// Names in the folder that are `prefix` and a result's name.
  std::vector<std::string> results_there(const std::string& prefix) const;
  /// Throws OutputError if there are files with the names of results, such as the answer of a
  /// recording, in a folder that is not a run's.
  void spare_foreign_files() const;
  /// Keeps other runs out for as long as this one lives. Throws OutputError if one is there.
  void lock();
  std::filesystem::path directory_;
  std::vector<std::string> results_;
  std::vector<std::string> names_;
  bool made_ = false;
  bool keep_ = false;
  int descriptor_ = -1;  ///< of the locked folder
};

}  // namespace hypotrack
