#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/launch.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_folder.hpp"
#include "run/crew/job.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

// With `recordings: true` a study writes every source once as a recording (`hypotrack synth`),
// which all runs read. So a synthetic source is rendered once for each draw of its noise, not in
// every run.

/// Returns the name of the recording that a run reads. Runs share it if their scene files and
/// their changes of models and source are the same, noise included.
std::string recording_id(const Plan& plan, const PlannedRun& run);

/// Makes the recordings of the given runs (indices into the plan), each in a separate process. Also
/// waits for recordings that other processes make. Calls `again` now and then; it ends the work by
/// returning false. Throws DataError with the error of a failed recording.
void make_recordings(const StudyFolder& folder, const Plan& plan,
                     const std::vector<std::size_t>& runs, const Launch& launch,
                     const std::function<bool()>& again);

/// Splits runs for work on one batch after the other. Recordings whose noise is redrawn make a
/// batch of each seed, so that only its recordings need room on the disk.
std::vector<std::vector<std::size_t>> batches_of(const Plan& plan,
                                                 const std::vector<std::size_t>& runs);

/// Knows which runs read each recording whose noise is redrawn.
class RedrawnRecordings {
 public:
  explicit RedrawnRecordings(const Plan& plan);
  /// Removes the recordings of the given runs that no unfinished or failed run of the study reads.
  void remove_read(const StudyFolder& folder, const std::vector<std::size_t>& runs) const;

 private:
  const Plan& plan_;
  std::map<std::string, std::vector<std::size_t>> readers_;
};

/// Returns the job of a run: the scene and its settings. The scene of a recording already contains
/// the changes of models and source.
Job job_of(const StudyFolder& folder, const Plan& plan, const PlannedRun& run,
           const Launch& launch);

}  // namespace internal
}  // namespace hypotrack::study
