#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// The folder of a run's results. Files grow under a name of their own (`.track.csv.part`) and get
/// their real one all together when the run ends, so that whatever carries a final name is whole.
class HYPOTRACK_API RunDirectory {
 public:
  /// Makes the folder if need be and removes what an earlier, killed run left unfinished. Throws
  /// OutputError if the folder cannot be made or written.
  explicit RunDirectory(std::filesystem::path directory);

  const std::filesystem::path& path() const { return directory_; }

  /// Where to write the file that will be called `name`. A video keeps its suffix.
  std::filesystem::path part(const std::string& name);

  /// Gives every file of part() its final name, replacing what an earlier run left there, and
  /// removes results of an earlier run in `stale` that this one did not write.
  void finish(const std::vector<std::string>& stale = {});

 private:
  std::filesystem::path part_path(const std::string& name) const;
  std::filesystem::path directory_;
  std::vector<std::string> names_;
};

}  // namespace hypotrack
