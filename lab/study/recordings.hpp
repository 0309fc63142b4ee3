#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <future>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/study/launch.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_folder.hpp"
#include "run/crew/job.hpp"
#include "run/crew/process_pool.hpp"

namespace hypotrack::study {
inline namespace HYPOTRACK_EXPORTED internal {

// With `recordings: true` a study writes every source once as a recording (`hypotrack synth`),
// which all runs read. So a synthetic source is rendered once for each draw of its noise, not in
// every run.

/// Returns the name of the recording that a run reads. Runs share it if their scene files and
/// their changes of models and source are the same, noise included.
std::string recording_id(const Plan& plan, const PlannedRun& run);

/// Makes the recordings that the given runs (indices into the plan) read, each in a process of its
/// own: those of the next runs first. Recordings whose noise is redrawn need much room on the disk,
/// so those of two seeds are made at a time, and removed when the study has the runs that read
/// them, while later ones are made.
class Recordings {
 public:
  Recordings(const StudyFolder& folder, const Plan& plan, const std::vector<std::size_t>& runs,
             const Launch& launch);

  /// Returns true if a run may begin: its recording is there, or it reads none.
  bool are_there_for(std::size_t run) const;
  /// Returns whether some were not looked for yet.
  bool are_wanted() const { return !wanted_.empty(); }
  /// Returns the number of recordings being made by this process.
  std::size_t size() const { return pool_.size(); }
  /// Starts up to `room` recordings of the seed of `next`, the run to be made next, and up to
  /// `ahead` others. Puts complete ones into place. Returns false if nothing happened. Throws
  /// DataError with the error of a failed recording.
  bool go_on(std::size_t next, std::size_t room, std::size_t ahead);
  /// Ends the recordings being made.
  void stop();
  /// Stops, and removes the recordings that were made unless another process has begun the study.
  void discard();
  /// Removes the recording of a run, in a thread of its own, if its noise was redrawn and the study
  /// has all runs that read it.
  void remove_if_read(std::size_t run);

 private:
  using Clock = std::chrono::steady_clock;
  struct Wanted {
    std::string id;
    std::size_t run;  ///< a run that reads it
  };

  std::size_t seeds_before(const Wanted& wanted, std::size_t run) const;
  bool take_in_hand(const Wanted& wanted, bool may_start);
  void finish(const Ended& ended);
  void remove_in_thread(const std::string& id);

  const StudyFolder& folder_;
  const Plan& plan_;
  const Launch& launch_;
  std::map<std::size_t, std::string> ids_;                   ///< recording of each run
  std::map<std::string, std::vector<std::size_t>> readers_;  ///< of those whose noise is redrawn
  std::map<std::int64_t, std::size_t> seeds_;                ///< their order
  std::vector<Wanted> wanted_;   ///< not begun, in the order of the runs
  std::set<std::string> there_;  ///< complete
  std::set<std::string> made_;   ///< by this process
  std::size_t begun_ = 0;        ///< by this process
  Clock::time_point next_look_;
  std::map<std::size_t, RunFolder> working_;  ///< outlives the processes of pool_
  std::vector<std::future<void>> removals_;
  ProcessPool pool_;
};

/// Makes the first recordings of a study in a new folder, on cores that no run uses, while its
/// cells are checked. Takes them back at its end unless the study begins.
class RecordingsAhead {
 public:
  /// `runs`: those to be made. All arguments must outlive the object.
  RecordingsAhead(const StudyFolder& folder, Recordings& recordings,
                  const std::vector<std::size_t>& runs, const Launch& launch);
  ~RecordingsAhead();
  RecordingsAhead(const RecordingsAhead&) = delete;
  RecordingsAhead& operator=(const RecordingsAhead&) = delete;

  /// Starts and ends recordings. A failure waits: a check may tell it better.
  void go_on();
  /// Leaves the recordings to the study. Throws DataError if one failed.
  void keep();

 private:
  const StudyFolder& folder_;
  Recordings& recordings_;
  std::size_t first_ = 0, room_ = 0;  ///< the first run; recordings at a time
  std::exception_ptr failure_;
  bool kept_ = false;
};

/// Returns the job of a run: the scene and its settings. The scene of a recording already contains
/// the changes of models and source.
Job job_of(const StudyFolder& folder, const Plan& plan, const PlannedRun& run,
           const Launch& launch);

}  // namespace internal
}  // namespace hypotrack::study
