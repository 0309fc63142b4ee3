#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "base/exported.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A folder that stays the same while others rename it or make another one of its name.
class OpenFolder {
 public:
  /// Opens a folder. Throws OutputError.
  explicit OpenFolder(std::filesystem::path folder);
  ~OpenFolder();
  OpenFolder(const OpenFolder&) = delete;
  OpenFolder& operator=(const OpenFolder&) = delete;

  /// Returns a path of the folder that follows it. It is for this process only, during the life of
  /// the object.
  const std::filesystem::path& path() const { return path_; }
  /// Returns the name of the folder for people: as it was given, or the new one.
  std::filesystem::path place() const;
  /// Returns true if the folder no longer has the name by which it was opened.
  bool moved() const { return !has_name(name_); }
  /// Returns false if the folder was removed.
  bool exists() const;
  /// Throws OutputError if the folder was removed.
  void expect_exists() const;
  /// Returns a text in which the folder has its name for people.
  std::string shown(std::string text) const;
  /// Locks the folder (flock) for the life of the object. Returns false if another process has the
  /// lock; true also where locks are not supported.
  bool lock() const;

  /// Calls a function that writes into the folder. Its errors name the folder for people, or say
  /// that it was removed.
  template <class Function>
  decltype(auto) write_with(const Function& function) const {
    try {
      return function();
    } catch (const OutputError& error) {
      refuse<OutputError>(error.what());
    } catch (const PluginError& error) {
      refuse<PluginError>(error.what());
    } catch (const std::system_error& error) {
      refuse<OutputError>(described(error));
    }
  }

 private:
  bool has_name(const std::filesystem::path& name) const;
  static std::string described(const std::system_error& error);
  template <class Refusal>
  [[noreturn]] void refuse(const std::string& text) const {
    expect_exists();
    throw Refusal(shown(text));
  }

  std::filesystem::path name_;  ///< as given
  int descriptor_;
  std::filesystem::path path_;
};

}  // namespace internal
}  // namespace hypotrack
