#include "lab/study/recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "lab/study/hash.hpp"
#include "lab/study/noise.hpp"
#include "run/crew/crew.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr std::chrono::milliseconds kLook{20};  // interval of looks for recordings to be made

std::vector<Change> select(const std::vector<Change>& changes, bool recorded) {
  std::vector<Change> selected;
  for (const Change& change : changes)
    if (is_recorded(change) == recorded) selected.push_back(change);
  return selected;
}

Subprocess::Command synth_command(const Plan& plan, const PlannedRun& run, const Launch& launch,
                                  const RunFolder& folder) {
  auto arguments = scene_arguments("synth", plan.scene_of(plan.cells[run.cell]).file,
                                   select(plan.changes_of(run), true), plan, launch);
  arguments.insert(arguments.end(), {"--out", (folder.working() / "recording").string(), "--format",
                                     launch.pictures});
  return work_command(launch, plan, std::move(arguments), folder);
}

}  // namespace

std::string recording_id(const Plan& plan, const PlannedRun& run) {
  const Cell& cell = plan.cells[run.cell];
  Hash hash;
  hash.add(plan.scene_texts[cell.scene]);
  for (const Change& change : select(plan.changes_of(run), true)) hash.add(change.meaning());
  hash.add(plan.study.frames ? fmt::format("{}", *plan.study.frames) : "all");
  return fmt::format("{}_{:016x}", plan.scene_of(cell).file.stem().string(), hash.value());
}

Recordings::Recordings(const StudyFolder& folder, const Plan& plan,
                       const std::vector<std::size_t>& runs, const Launch& launch)
    : folder_(folder), plan_(plan), launch_(launch) {
  if (!plan.study.recordings) return;
  std::set<std::string> known;
  for (const std::size_t run : runs) {
    const std::string& id = ids_[run] = recording_id(plan, plan.runs[run]);
    if (known.insert(id).second) wanted_.push_back({id, run});
    seeds_.try_emplace(plan.runs[run].seed, seeds_.size());
  }
  for (std::size_t i = 0; i < plan.runs.size(); ++i)
    if (plan.cells[plan.runs[i].cell].noise)
      readers_[recording_id(plan, plan.runs[i])].push_back(i);
}

bool Recordings::are_there_for(std::size_t run) const {
  return !plan_.study.recordings || there_.contains(ids_.at(run));
}

bool Recordings::go_on(std::size_t next, std::size_t room, std::size_t ahead) {
  const auto ended = pool_.take_ended();
  if (ended) finish(*ended);
  if (Clock::now() < next_look_) return ended.has_value();
  next_look_ = Clock::now() + kLook;
  const std::size_t most = pool_.size() + room;
  std::erase_if(wanted_, [&](const Wanted& each) {
    const std::size_t seeds = seeds_before(each, next);
    return seeds <= 1 &&
           take_in_hand(each, pool_.size() < (seeds == 0 ? most : std::min(most, ahead)));
  });
  return ended.has_value();
}

/// Returns how many seeds a recording is ahead of a run; 0 if its noise is not redrawn.
std::size_t Recordings::seeds_before(const Wanted& wanted, std::size_t run) const {
  if (!readers_.contains(wanted.id)) return 0;
  const std::size_t own = seeds_.at(plan_.runs[wanted.run].seed);
  const std::size_t now = seeds_.at(plan_.runs[run].seed);
  return own > now ? own - now : 0;
}

/// Returns false if a recording is neither there nor was started.
bool Recordings::take_in_hand(const Wanted& wanted, bool may_start) {
  const auto is_there = [&] { return std::filesystem::exists(folder_.recording_path(wanted.id)); };
  if (is_there()) return there_.insert(wanted.id).second;
  // Another process may have made the runs, and removed what nobody reads any more.
  const bool is_read = std::ranges::all_of(ids_, [&](const auto& run) {
    return run.second != wanted.id || folder_.state(plan_.runs[run.first]) == RunState::ok;
  });
  if (is_read) return there_.insert(wanted.id).second;
  if (!may_start) return false;
  auto claimed = folder_.claim_recording(wanted.id);
  if (!claimed) return false;  // another process makes it
  if (is_there()) return there_.insert(wanted.id).second;
  Subprocess::Command command = synth_command(plan_, plan_.runs[wanted.run], launch_, *claimed);
  // GPUs draw in turn, so that no GPU's runs wait more.
  constexpr const char* kDraws = "HYPOTRACK_GL_GPU";
  if (const auto& gpus = launch_.gpus; !gpus.empty() && !std::getenv(kDraws))
    command.variables.push_back(fmt::format("{}={}", kDraws, gpus[begun_++ % gpus.size()]));
  pool_.start(wanted.run, std::move(command));
  working_.emplace(wanted.run, *std::move(claimed));
  return true;
}

void Recordings::finish(const Ended& ended) {
  RunFolder& folder = working_.at(ended.key);
  const Cell& cell = plan_.cells[plan_.runs[ended.key].cell];
  // The scene is written last.
  if (ended.end.code != 0 || !std::filesystem::exists(folder.working() / "recording/scene.yaml"))
    throw DataError(fmt::format("{}: {}: its source cannot be recorded: {}",
                                plan_.scene_of(cell).where, plan_.describe(cell),
                                failure_message(folder.log(), ended)));
  folder.put_into_place();
  working_.erase(ended.key);
  there_.insert(ids_.at(ended.key));
  made_.insert(ids_.at(ended.key));
}

void Recordings::stop() {
  pool_ = ProcessPool(0);
  working_.clear();
}

void Recordings::discard() {
  stop();
  if (folder_.has_plan()) return;
  std::error_code ignored;
  for (const std::string& id : made_)
    std::filesystem::remove_all(folder_.recording_path(id), ignored);
}

void Recordings::remove_if_read(std::size_t run) {
  const auto id = ids_.find(run);
  if (id == ids_.end()) return;
  const auto readers = readers_.find(id->second);
  if (readers == readers_.end()) return;  // pictures that are not rendered
  const bool read = std::ranges::all_of(readers->second, [&](std::size_t reader) {
    return folder_.state(plan_.runs[reader]) == RunState::ok;
  });
  if (!read) return;
  try {
    remove_in_thread(id->second);
  } catch (const std::exception&) {  // no room for a lock, or no thread
    std::error_code ignored;
    std::filesystem::remove_all(folder_.recording_path(id->second), ignored);
  }
}

/// To remove gigabytes takes seconds, in which runs could begin.
void Recordings::remove_in_thread(const std::string& id) {
  auto claimed = folder_.claim_recording(id);
  if (!claimed) return;  // another process is faster
  std::filesystem::rename(folder_.recording_path(id), claimed->working() / "read");
  std::erase_if(removals_, [](const std::future<void>& one) {
    return one.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  removals_.push_back(std::async(std::launch::async, [folder = *std::move(claimed)]() mutable {
    const RunFolder removed = std::move(folder);
  }));
}

RecordingsAhead::RecordingsAhead(const StudyFolder& folder, Recordings& recordings,
                                 const std::vector<std::size_t>& runs, const Launch& launch)
    : folder_(folder), recordings_(recordings) {
  if (runs.empty() || !recordings.are_wanted()) return;
  first_ = std::ranges::min(runs);
  const int room = std::min(launch.jobs, launch.spare_cores / launch.threads);
  if (room > 0 && folder.open()) room_ = static_cast<std::size_t>(room);
}

RecordingsAhead::~RecordingsAhead() {
  if (kept_ || room_ == 0) return;
  try {
    recordings_.discard();
    folder_.abandon();
  } catch (const std::exception&) {  // the folder is gone, and a message is on its way
  }
}

void RecordingsAhead::go_on() {
  if (room_ == 0 || failure_) return;
  try {
    (void)recordings_.go_on(first_, room_ - std::min(room_, recordings_.size()), 0);
  } catch (const DataError&) {
    failure_ = std::current_exception();
  }
}

void RecordingsAhead::keep() {
  if (failure_) std::rethrow_exception(failure_);
  kept_ = true;
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
