#include "lab/study/recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "hypotrack/error.hpp"
#include "lab/study/hash.hpp"
#include "lab/study/noise.hpp"
#include "run/crew/failure_message.hpp"
#include "run/crew/process_pool.hpp"

namespace hypotrack::study::internal {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kRecordingPoll{20};

std::vector<Change> select(const std::vector<Change>& changes, bool recorded) {
  std::vector<Change> selected;
  for (const Change& change : changes)
    if (is_recorded(change) == recorded) selected.push_back(change);
  return selected;
}

/// Recordings still to be made, by name, with a run that needs each.
using Wanted = std::map<std::string, std::size_t>;

Subprocess::Command synth_command(const Plan& plan, const PlannedRun& run, const Launch& launch,
                                  const RunFolder& folder) {
  auto arguments = scene_arguments("synth", plan.scene_of(plan.cells[run.cell]).file,
                                   select(plan.changes_of(run), true), plan, launch);
  arguments.insert(arguments.end(), {"--out", (folder.working() / "recording").string(), "--format",
                                     launch.pictures});
  return work_command(launch, plan, std::move(arguments), folder);
}

class Recorder {
 public:
  Recorder(const StudyFolder& folder, const Plan& plan, const Launch& launch)
      : folder_(folder), plan_(plan), launch_(launch) {}

  void work(Wanted wanted, const std::function<bool()>& again) {
    while (again() && (!wanted.empty() || pool_.size() > 0)) {
      for (auto it = wanted.begin(); it != wanted.end();)
        it = take_in_hand(it->first, it->second) ? wanted.erase(it) : std::next(it);
      if (const auto ended = pool_.take_ended())
        finish(*ended);
      else
        std::this_thread::sleep_for(kRecordingPoll);
    }
  }

 private:
  /// Starts a recording. Returns false if it must wait for a free slot or another process.
  bool take_in_hand(const std::string& id, std::size_t run) {
    if (std::filesystem::exists(folder_.recording_path(id))) return true;
    if (pool_.size() >= static_cast<std::size_t>(launch_.jobs)) return false;
    auto claimed = folder_.claim_recording(id);
    if (!claimed) return false;
    if (std::filesystem::exists(folder_.recording_path(id))) return true;
    pool_.start(run, synth_command(plan_, plan_.runs[run], launch_, *claimed));
    working_.emplace(run, *std::move(claimed));
    return true;
  }

  void finish(const Ended& ended) {
    RunFolder& folder = working_.at(ended.key);
    const Cell& cell = plan_.cells[plan_.runs[ended.key].cell];
    // The scene is written last.
    if (ended.end.code != 0 || !std::filesystem::exists(folder.working() / "recording/scene.yaml"))
      throw DataError(fmt::format("{}: {}: its source cannot be recorded: {}",
                                  plan_.scene_of(cell).where, plan_.describe(cell),
                                  failure_message(folder.log(), ended)));
    folder.put_into_place();
    working_.erase(ended.key);
  }

  const StudyFolder& folder_;
  const Plan& plan_;
  const Launch& launch_;
  std::map<std::size_t, RunFolder> working_;  // declared before pool_, whose processes must end
                                              // first
  ProcessPool pool_;
};

}  // namespace

std::string recording_id(const Plan& plan, const PlannedRun& run) {
  const Cell& cell = plan.cells[run.cell];
  Hash hash;
  hash.add(plan.scene_texts[cell.scene]);
  for (const Change& change : select(plan.changes_of(run), true)) hash.add(change.meaning());
  hash.add(plan.study.frames ? fmt::format("{}", *plan.study.frames) : "all");
  return fmt::format("{}_{:016x}", plan.scene_of(cell).file.stem().string(), hash.value());
}

void make_recordings(const StudyFolder& folder, const Plan& plan,
                     const std::vector<std::size_t>& runs, const Launch& launch,
                     const std::function<bool()>& again) {
  Wanted wanted;
  for (const std::size_t run : runs)
    if (folder.state(plan.runs[run]) != RunState::ok)  // by another process meanwhile
      wanted.emplace(recording_id(plan, plan.runs[run]), run);
  Recorder(folder, plan, launch).work(std::move(wanted), again);
}

std::vector<std::vector<std::size_t>> batches_of(const Plan& plan,
                                                 const std::vector<std::size_t>& runs) {
  std::vector<std::vector<std::size_t>> batches;
  const bool by_seed = plan.study.recordings && plan.study.redraw == Redraw::noise;
  for (const std::size_t run : runs) {
    if (batches.empty() ||
        (by_seed && plan.runs[batches.back().back()].seed != plan.runs[run].seed))
      batches.emplace_back();
    batches.back().push_back(run);
  }
  return batches;
}

RedrawnRecordings::RedrawnRecordings(const Plan& plan) : plan_(plan) {
  if (!plan.study.recordings) return;
  for (std::size_t i = 0; i < plan.runs.size(); ++i)
    if (plan.cells[plan.runs[i].cell].noise)
      readers_[recording_id(plan, plan.runs[i])].push_back(i);
}

void RedrawnRecordings::remove_read(const StudyFolder& folder,
                                    const std::vector<std::size_t>& runs) const {
  if (readers_.empty()) return;
  std::set<std::string> ids;
  for (const std::size_t run : runs) ids.insert(recording_id(plan_, plan_.runs[run]));
  for (const std::string& id : ids) {
    const auto readers = readers_.find(id);
    if (readers == readers_.end()) continue;  // pictures that are not rendered
    const bool read = std::ranges::all_of(readers->second, [&](std::size_t run) {
      return folder.state(plan_.runs[run]) == RunState::ok;
    });
    std::error_code ignored;  // another process may be faster
    if (read) std::filesystem::remove_all(folder.recording_path(id), ignored);
  }
}

Job job_of(const StudyFolder& folder, const Plan& plan, const PlannedRun& run,
           const Launch& launch) {
  const std::vector<Change> changes = plan.changes_of(run);
  Job job;
  if (plan.study.recordings) {
    job.scene = folder.recording_path(recording_id(plan, run)) / "recording" / "scene.yaml";
    job.set = settings_of(select(changes, false), plan, launch);
  } else {
    job.scene = plan.scene_of(plan.cells[run.cell]).file;
    job.set = settings_of(changes, plan, launch);
  }
  job.set.push_back(fmt::format("seed={}", run.seed));
  job.frames = plan.study.frames;
  return job;
}

}  // namespace hypotrack::study::internal
