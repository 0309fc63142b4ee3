#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "study/plan.hpp"

namespace hypotrack::study {

/// How the runs of a study are started.
struct Launch {
  std::filesystem::path program;                   ///< `hypotrack`
  std::vector<std::filesystem::path> plugin_path;  ///< absolute
  int jobs = 1;                                    ///< at the same time
  int threads = 1;                                 ///< of each
};

/// The arguments that say which scene a cell is: the file, every change, and before those the
/// study's own: threads, overlay.
std::vector<std::string> scene_arguments(const Plan& plan, const Cell& cell, const Launch& launch);

/// Opens the scene of every given cell as a run would, up to its first frame, each in a process of
/// its own. `again` is asked now and then, and stops the work by returning false. Throws
/// ConfigError with what is wrong, and the line of the study that it comes from.
HYPOTRACK_API void check_cells(const Plan& plan, const std::vector<std::size_t>& cells,
                               const Launch& launch, const std::function<bool()>& again);

}  // namespace hypotrack::study
