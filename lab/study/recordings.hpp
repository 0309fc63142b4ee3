#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lab/study/launch.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_folder.hpp"

namespace hypotrack::study {

// With `recordings: true` a study writes every source once as a recording (`hypotrack synth`),
// which all runs read. So a synthetic source is rendered once, not in every run.

/// Returns the name of the recording that a cell reads. Cells share it if their scene files and
/// their changes of models and source are the same.
std::string recording_id(const Plan& plan, const Cell& cell);

/// Makes the recordings of the given cells, each in a separate process. Also waits for those that
/// other processes make. Calls `again` now and then; it ends the work by returning false. Throws
/// DataError with the error of a failed recording.
void make_recordings(const StudyFolder& folder, const Plan& plan,
                     const std::vector<std::size_t>& cells, const Launch& launch,
                     const std::function<bool()>& again);

/// Returns the first arguments of `hypotrack run` for a cell: `run`, the scene and the changes. The
/// scene of a recording already contains the changes of models and source.
std::vector<std::string> run_arguments(const StudyFolder& folder, const Plan& plan,
                                       const Cell& cell, const Launch& launch);

}  // namespace hypotrack::study
