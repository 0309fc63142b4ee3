#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/launch.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/recordings.hpp"
#include "lab/study/study_folder.hpp"
#include "run/crew/crew.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

/// Checks the scenes of the given cells: a crew opens each as a run would, up to its first frame.
/// Returns the number of the GPU that each takes, for those that take one. Calls `again` now and
/// then; it stops the work by returning false. Throws ConfigError with all problems and the lines
/// of the study that they come from.
std::map<std::size_t, int> check_cells(const Plan& plan, const std::vector<std::size_t>& cells,
                                       const Launch& launch, Crew& crew,
                                       const std::function<bool()>& again);

/// Observer of the runs of a study, which can stop them.
class Watcher {
 public:
  virtual ~Watcher();
  /// Returns true to end the work. Called some hundred times per second.
  virtual bool stop() = 0;
  /// Called when a run is finished, by this or another process. `failure` is empty if it succeeded.
  virtual void on_run(const PlannedRun& run, const std::string& failure) = 0;
  /// Receives a line for the user.
  virtual void say(const std::string& text) = 0;
};

/// Makes the given runs (indices into the plan) with a crew, and the recordings that they read
/// beside them. `gpus`: number of the GPU of each cell that takes one. Also waits for runs that
/// other processes are making. Records failures in the folder. Throws DataError if a recording
/// failed. Returns false if the watcher, or somebody who interrupted a run, ended the work early;
/// unfinished runs are then given up. Throws OutputError.
bool execute(const StudyFolder& folder, const Plan& plan, const std::vector<std::size_t>& runs,
             const Launch& launch, const std::map<std::size_t, int>& gpus, Crew& crew,
             Recordings& recordings, Watcher& watcher);

}  // namespace internal
}  // namespace hypotrack::study
