#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "lab/study/launch.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/study_folder.hpp"

namespace hypotrack::study {

/// Who watches the runs of a study.
class HYPOTRACK_API Watcher {
 public:
  virtual ~Watcher();
  /// Asked some hundred times per second; true ends the work.
  virtual bool stop() = 0;
  /// A run is there now, made here or by another process. `failure` is empty if it succeeded.
  virtual void on_run(const PlannedRun& run, const std::string& failure) = 0;
};

/// Makes the given runs (indices into the plan), each in a process of its own, and waits for those
/// that other processes have in hand. A run that fails is noted in the folder. False if the watcher
/// or somebody who interrupted a run ended the work early: what was being made is then given up.
/// Throws OutputError.
HYPOTRACK_API bool execute(const StudyFolder& folder, const Plan& plan,
                           const std::vector<std::size_t>& runs, const Launch& launch,
                           Watcher& watcher);

}  // namespace hypotrack::study
