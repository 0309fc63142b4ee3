#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/exported.hpp"
#include "base/open_folder.hpp"
#include "session/scene_file.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A new folder that is named `.part.NAME` until it is complete. The folder that it is in may be
/// renamed meanwhile.
class RecordingFolder {
 public:
  /// Removes an unfinished folder of that name. Throws OutputError if the folder exists and is not
  /// empty, if it cannot be made, or if another process is writing into the unfinished one.
  explicit RecordingFolder(const std::filesystem::path& folder);
  /// Removes the folder unless it is complete or kept.
  ~RecordingFolder();
  RecordingFolder(const RecordingFolder&) = delete;
  RecordingFolder& operator=(const RecordingFolder&) = delete;

  /// Returns the path of a file; the folder itself without a name. See OpenFolder::path().
  std::filesystem::path file(const std::string& name = {}) const { return part_->path() / name; }
  /// Calls a function that writes files, as OpenFolder::write_with() does.
  template <class Function>
  decltype(auto) write_with(const Function& function) const {
    return parent_->write_with([&]() -> decltype(auto) {
      part_->expect_exists();
      return part_->write_with(function);
    });
  }
  /// Gives the folder its name. Throws OutputError.
  void finish();
  /// Leaves an unfinished folder where it is.
  void keep() { done_ = true; }
  /// Returns where the complete folder is or will be, for people.
  std::filesystem::path place() const;

 private:
  void make_part();

  std::filesystem::path given_;
  std::string name_, part_name_;
  std::optional<OpenFolder> parent_, part_;
  bool done_ = false;
};

/// Copies the files that a scene's start reads into a folder, as start_NAME. Returns `init` as YAML
/// that names the copies; a file that does not exist keeps its absolute path. Throws OutputError.
std::string copy_start_files(const InitSettings& init, const std::filesystem::path& folder);

}  // namespace internal
}  // namespace hypotrack
