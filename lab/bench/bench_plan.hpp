#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack::bench {
inline namespace HYPOTRACK_EXPORTED internal {

/// A scene to measure.
struct Case {
  std::string name;   ///< name for selection on the command line
  std::string label;  ///< name in tables
  std::filesystem::path file;
  std::vector<std::string> overrides;  ///< `key.path=value`
  std::filesystem::path directory;     ///< base of relative paths in the overrides
};

/// A configuration in which every scene is tracked: a backend, perhaps with an optimizer made for
/// it.
struct Configuration {
  std::string name;
  std::vector<std::string> overrides;  ///< applied after those of the case
};

/// Cases and configurations of a benchmark; every case is tracked in every configuration.
struct Plan {
  std::string title;
  std::vector<Case> cases;
  std::vector<Configuration> configurations;
  std::optional<int> frames;  ///< number to measure of each
};

/// The user's selection for a benchmark.
struct Request {
  std::filesystem::path table;         ///< study file whose grid has an axis `backend`
  std::optional<std::string> variant;  ///< of the table
  /// Names of the table's scenes, or scene files to measure in their place; empty: the whole table.
  std::vector<std::string> scenes;
  std::vector<std::string> set;       ///< further overrides for every case
  std::vector<std::string> backends;  ///< configurations to keep; empty: all
};

/// Makes a plan. Throws ConfigError if the table or a scene cannot be read, a scene does not fit
/// its overrides, or a name is not in the table.
Plan make_plan(const Request& request);

/// Makes the directory of a case the working directory, so that relative paths in overrides work.
void enter_directory(const Case& c);

}  // namespace internal
}  // namespace hypotrack::bench
