#include "lab/study/execute.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "cost/cuda/backend_text.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "lab/study/recordings.hpp"
#include "lab/study/run_order.hpp"
#include "run/crew/crew.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr std::chrono::milliseconds kCheckPoll{5};
constexpr std::size_t kMostShown = 5;

/// Returns the line of the study that a message is about: that of the change it names, or the
/// scene's.
std::string position_of(const Plan& plan, const Cell& cell, const std::string& message) {
  for (const Change& change : plan.changes_of(cell))
    if (message.find("--set " + change.assignment()) != std::string::npos) return change.where;
  return plan.scene_of(cell).where;
}

/// Joins all problems to one message; names the same problem of several cells once.
std::string report(const Plan& plan, const std::map<std::size_t, std::string>& problems) {
  std::set<std::string> known;
  std::string text;
  for (const auto& [index, message] : problems) {
    if (!known.insert(message).second || known.size() > kMostShown) continue;
    const Cell& cell = plan.cells[index];
    text += fmt::format("{}{}: {}: {}", text.empty() ? "" : "\n  ",
                        position_of(plan, cell, message), plan.describe(cell), message);
  }
  return text + fmt::format("\n  {} of the study's {} cells cannot be run; nothing was run",
                            problems.size(), plan.cells.size());
}

/// Returns the job that checks a cell. A worker has a CUDA context already; a process would take a
/// second to make one.
Job check_of(const Plan& plan, std::size_t index, const Launch& launch, const Crew& crew) {
  const Cell& cell = plan.cells[index];
  Job job{.key = index, .scene = plan.scene_of(cell).file};
  job.set = settings_of(plan.changes_of(cell), plan, launch);
  job.log = crew.scratch() / fmt::format("check_{}", index);
  job.check = true;
  if (!launch.gpus.empty()) job.gpu = launch.gpus.front();
  return job;
}

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kRunPoll{5};
constexpr std::chrono::milliseconds kRetry{500};  // interval of looks at a run that another process
                                                  // is making
constexpr std::size_t kShareAhead = 4;            // of the jobs may make recordings for later
constexpr std::size_t kShareBeside = 2;           // and on cores that no run uses
constexpr int kInterrupted = 130;                 // exit code of a run that was told to stop

class Execution {
 public:
  Execution(const StudyFolder& folder, const Plan& plan, const std::vector<std::size_t>& runs,
            const Launch& launch, const std::map<std::size_t, int>& gpus, Crew& crew,
            Recordings& recordings, Watcher& watcher)
      : folder_(folder),
        plan_(plan),
        launch_(launch),
        gpus_(gpus),
        crew_(crew),
        watcher_(watcher),
        recordings_(recordings),
        order_(plan),
        jobs_(static_cast<std::size_t>(launch.jobs)),
        most_beside_(std::min(static_cast<std::size_t>(launch.spare_cores / launch.threads),
                              jobs_ / kShareBeside)) {
    for (const std::size_t run : runs) waiting_.push_back({run, {}, folder_.state(plan.runs[run])});
  }

  ~Execution() {
    if (!working_.empty()) crew_.kill();  // before the folders go
  }
  Execution(const Execution&) = delete;
  Execution& operator=(const Execution&) = delete;

  bool work() {
    while (!waiting_.empty() || !working_.empty()) {
      if (watcher_.stop()) return false;
      const bool recorded = go_on_recording();
      if (failure_ && working_.empty()) std::rethrow_exception(failure_);
      const bool started = !failure_ && start_next();
      idle_ = !started && room() > 0;
      const auto ended = crew_.take_ended();
      for (const std::string& note : crew_.take_notes()) watcher_.say(note);
      if (ended && !finish(*ended)) return false;
      if (!recorded && !started && !ended) std::this_thread::sleep_for(kRunPoll);
    }
    return true;
  }

 private:
  struct Waiting {
    std::size_t run;
    Clock::time_point retry;  ///< not to be tried before
    RunState before;          ///< a failure that was there before is tried again
  };

  bool go_on_recording();
  bool start_next();
  std::deque<Waiting>::iterator next_run();
  std::size_t room() const;
  std::size_t beside() const;
  void start(std::size_t run, RunFolder folder);
  bool finish(const Ended& ended);

  const StudyFolder& folder_;
  const Plan& plan_;
  const Launch& launch_;
  const std::map<std::size_t, int>& gpus_;
  Crew& crew_;
  Watcher& watcher_;
  std::deque<Waiting> waiting_;
  std::map<std::size_t, RunFolder> working_;
  Recordings& recordings_;
  RunOrder order_;
  std::size_t jobs_;
  std::size_t most_beside_;     ///< recordings on cores that no run uses
  bool idle_ = false;           ///< jobs are left that no run could take
  std::exception_ptr failure_;  ///< of a recording
};

/// Returns how many runs or recordings may begin now in place of each other.
std::size_t Execution::room() const {
  const std::size_t busy = crew_.size() + recordings_.size() - beside();
  return jobs_ > busy ? jobs_ - busy : 0;
}

/// Returns the number of recordings that are made on cores that no run uses.
std::size_t Execution::beside() const { return std::min(most_beside_, recordings_.size()); }

/// Makes recordings: first those that the next run waits for, then a few ahead, so that they are
/// there when their runs begin. Returns false if nothing happened.
bool Execution::go_on_recording() {
  if (waiting_.empty() || failure_) return false;
  const auto next = std::ranges::min(waiting_, {}, &Waiting::run).run;
  try {
    return recordings_.go_on(next, room() + most_beside_ - beside(),
                             idle_ ? jobs_ : std::max(jobs_ / kShareAhead, most_beside_));
  } catch (const DataError& error) {
    failure_ = std::current_exception();  // to be thrown when the runs that have begun have ended
    if (!working_.empty()) watcher_.say(fmt::format("failed: {}", error.what()));
    return false;
  }
}

/// Returns the waiting run that is to begin, of those whose recordings are there; end(): none.
std::deque<Execution::Waiting>::iterator Execution::next_run() {
  const auto now = Clock::now();
  std::vector<std::size_t> ready;
  for (const Waiting& each : waiting_)
    if (each.retry <= now && recordings_.are_there_for(each.run)) ready.push_back(each.run);
  if (ready.empty()) return waiting_.end();
  std::ranges::sort(ready);  // runs that another process makes come back at the end
  return std::ranges::find(waiting_, order_.next(ready, crew_.next_gpu()), &Waiting::run);
}

/// Starts a waiting run that no other process makes. Returns false if nothing can start now.
bool Execution::start_next() {
  if (room() == 0) return false;
  const auto it = next_run();
  if (it == waiting_.end()) return false;
  Waiting next = *it;
  waiting_.erase(it);
  const PlannedRun& run = plan_.runs[next.run];
  auto claimed = folder_.claim(run);
  if (!claimed) {
    next.retry = Clock::now() + kRetry;
    waiting_.push_back(next);
    return true;
  }
  const RunState state = folder_.state(run);
  if (state != RunState::ok && state == next.before) {
    start(next.run, *std::move(claimed));
  } else {  // another process was faster
    const auto failure = read_failure(folder_.run_path(run));
    recordings_.remove_if_read(next.run);
    watcher_.on_run(run, failure ? failure->message : "");
  }
  return true;
}

void Execution::start(std::size_t index, RunFolder folder) {
  const PlannedRun& run = plan_.runs[index];
  Job job = job_of(folder_, plan_, run, launch_);
  job.key = index;
  job.out = folder.working();
  job.log = folder.log();
  job.descriptors = {{folder.lock_descriptor(), folder.lock_descriptor()}};
  if (const auto gpu = gpus_.find(run.cell); gpu != gpus_.end()) job.gpu = gpu->second;
  const auto gpu = job.gpu ? crew_.next_gpu() : std::nullopt;
  if (gpu) order_.begins(index, *gpu);
  crew_.start(std::move(job));
  working_.emplace(index, std::move(folder));
}

bool Execution::finish(const Ended& ended) {
  const PlannedRun& run = plan_.runs[ended.key];
  RunFolder& folder = working_.at(ended.key);
  std::string failure;
  if (ended.end.code == 0 && folder.holds_a_complete_run()) {
    folder.finish(plan_, run, {ended.seconds, launch_.threads, ended.gpu});
    order_.took(ended.key, ended.seconds);
  } else {
    failure = failure_message(folder.log(), ended);
    if (ended.end.code == kInterrupted && failure.starts_with("interrupted")) return false;
    folder.fail(plan_, run, {failure, ended.end.code});
  }
  working_.erase(ended.key);
  recordings_.remove_if_read(ended.key);
  watcher_.on_run(run, failure);
  return true;
}

}  // namespace

std::map<std::size_t, int> check_cells(const Plan& plan, const std::vector<std::size_t>& cells,
                                       const Launch& launch, Crew& crew,
                                       const std::function<bool()>& again) {
  std::map<std::size_t, std::string> problems;
  std::map<std::size_t, int> gpus;
  std::size_t next = 0;
  while (again() && (next < cells.size() || crew.size() > 0)) {
    if (next < cells.size() && crew.has_room()) {
      crew.start(check_of(plan, cells[next++], launch, crew));
      continue;
    }
    const auto ended = crew.take_ended();
    if (!ended) {
      std::this_thread::sleep_for(kCheckPoll);
      continue;
    }
    const std::filesystem::path log = crew.scratch() / fmt::format("check_{}", ended->key);
    if (ended->end.code != 0)
      problems[ended->key] = failure_message(log, *ended);
    else if (const auto gpu = cuda::gpu_in(read_whole(log).value_or("")))
      gpus[ended->key] = *gpu;
  }
  if (crew.size() > 0) crew.kill();  // after an interrupt
  if (!problems.empty()) throw ConfigError(report(plan, problems));
  return gpus;
}

Watcher::~Watcher() = default;

bool execute(const StudyFolder& folder, const Plan& plan, const std::vector<std::size_t>& runs,
             const Launch& launch, const std::map<std::size_t, int>& gpus, Crew& crew,
             Recordings& recordings, Watcher& watcher) {
  const bool complete =
      Execution(folder, plan, runs, launch, gpus, crew, recordings, watcher).work();
  if (!complete) recordings.stop();
  return complete;
}

}  // namespace hypotrack::study::internal
