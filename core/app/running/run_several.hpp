#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"

namespace hypotrack::app {

/// Runs of several scenes.
struct SeveralRuns {
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> set;  ///< overrides, for all
  std::filesystem::path out;     ///< each writes into a folder of its name there
  std::optional<int> frames, jobs;
  std::optional<std::string> gpus;  ///< text of --gpus
};

/// Makes the runs, says how each ended, and returns the exit code: 1 if any failed. Throws
/// ConfigError before anything runs if two have the same name or a scene is wrong.
int run_several(const SeveralRuns& runs, const CommonOptions& common);

}  // namespace hypotrack::app
