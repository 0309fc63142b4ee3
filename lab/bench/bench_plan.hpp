#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack::bench {

/// A scene to measure.
struct Case {
  std::string name;   ///< by which it is asked for
  std::string label;  ///< in tables
  std::filesystem::path file;
  std::vector<std::string> overrides;  ///< `key.path=value`
  std::filesystem::path directory;     ///< what relative paths in the overrides refer to
};

/// A way to track every scene: a backend, perhaps with an optimizer made for it.
struct Way {
  std::string name;
  std::vector<std::string> overrides;  ///< after those of the case
};

/// Every case is tracked in every way.
struct Plan {
  std::string title;
  std::vector<Case> cases;
  std::vector<Way> ways;
  std::optional<int> frames;  ///< to measure of each
};

/// What is asked for.
struct Request {
  std::filesystem::path table;         ///< study file whose grid has an axis `backend`
  std::optional<std::string> variant;  ///< of the table
  /// Names of the table's scenes, or scene files to measure in their place; empty: the whole table.
  std::vector<std::string> scenes;
  std::vector<std::string> set;       ///< further overrides for every case
  std::vector<std::string> backends;  ///< ways to keep; empty: all
};

/// Throws ConfigError if the table or a scene cannot be read, a scene does not fit its overrides,
/// or a name is not one of the table's.
HYPOTRACK_API Plan make_plan(const Request& request);

/// Makes the directory of a case the working directory, which overrides are read relative to.
void enter_directory(const Case& c);

}  // namespace hypotrack::bench
