#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/study/launch.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_folder.hpp"

namespace hypotrack::study {

// A study with `recordings: true` writes every source as a recording once (`hypotrack synth`), and
// all runs read that: a synthetic source is drawn once and not in every run.

/// Name of the recording that a cell reads: the same for all cells whose scene file is the same and
/// has the same changes in its models and source.
HYPOTRACK_API std::string recording_id(const Plan& plan, const Cell& cell);

/// Makes the recordings of the given cells, each in a process of its own, and waits for those that
/// other processes make. `again` is asked now and then and ends the work by returning false.
/// Throws DataError with what a recording failed with.
HYPOTRACK_API void make_recordings(const StudyFolder& folder, const Plan& plan,
                                   const std::vector<std::size_t>& cells, const Launch& launch,
                                   const std::function<bool()>& again);

/// The first arguments of `hypotrack run` for a cell: `run`, the cell's own scene or that of its
/// recording, which has what the study changes in models and source already, and the changes.
std::vector<std::string> run_arguments(const StudyFolder& folder, const Plan& plan,
                                       const Cell& cell, const Launch& launch);

}  // namespace hypotrack::study
