#include "lab/study/execute.hpp"

#include <fmt/format.h>

#include <chrono>
#include <deque>
#include <map>
#include <thread>
#include <utility>

#include "lab/study/failure_message.hpp"
#include "lab/study/process_pool.hpp"
#include "lab/study/recordings.hpp"

namespace hypotrack::study::internal {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kRunPoll{5};
constexpr std::chrono::milliseconds kRetry{500};  // interval of looks at a run that another process
                                                  // is making
constexpr int kInterrupted = 130;                 // exit code of a run that was told to stop

class Execution {
 public:
  Execution(const StudyFolder& folder, const Plan& plan, const std::vector<std::size_t>& runs,
            const Launch& launch, Watcher& watcher)
      : folder_(folder),
        plan_(plan),
        launch_(launch),
        watcher_(watcher),
        pool_(launch.time_limit_s) {
    for (const std::size_t run : runs) waiting_.push_back({run, {}, folder_.state(plan.runs[run])});
  }

  bool work() {
    while (!waiting_.empty() || pool_.size() > 0) {
      if (watcher_.stop()) return false;
      const bool moved = start_next();
      const auto ended = pool_.take_ended();
      if (ended && !finish(*ended)) return false;
      if (!moved && !ended) std::this_thread::sleep_for(kRunPoll);
    }
    return true;
  }

 private:
  struct Waiting {
    std::size_t run;
    Clock::time_point retry;  ///< not to be tried before
    RunState before;          ///< a failure that was there before is tried again
  };

  bool start_next();
  void start(std::size_t run, RunFolder folder);
  bool finish(const Ended& ended);

  const StudyFolder& folder_;
  const Plan& plan_;
  const Launch& launch_;
  Watcher& watcher_;
  std::deque<Waiting> waiting_;
  std::map<std::size_t, RunFolder> working_;  // declared before pool_, whose processes must end
                                              // first
  ProcessPool pool_;
};

/// Starts the first waiting run that no other process makes. Returns false if nothing can start
/// now.
bool Execution::start_next() {
  if (waiting_.empty() || pool_.size() >= static_cast<std::size_t>(launch_.jobs)) return false;
  Waiting next = waiting_.front();
  if (next.retry > Clock::now()) return false;  // all behind it wait longer
  waiting_.pop_front();
  const PlannedRun& run = plan_.runs[next.run];
  auto claimed = folder_.claim(run);
  if (!claimed) {
    next.retry = Clock::now() + kRetry;
    waiting_.push_back(next);
    return true;
  }
  if (folder_.state(run) == next.before) {
    start(next.run, *std::move(claimed));
  } else {  // another process was faster
    const auto failure = read_failure(folder_.run_path(run));
    watcher_.on_run(run, failure ? failure->message : "");
  }
  return true;
}

void Execution::start(std::size_t index, RunFolder folder) {
  const PlannedRun& run = plan_.runs[index];
  auto arguments = run_arguments(folder_, plan_, run, launch_);
  arguments.insert(arguments.end(),
                   {"--out", folder.working().string(), "--seed", fmt::format("{}", run.seed)});
  pool_.start(index, work_command(launch_, plan_, std::move(arguments), folder));
  working_.emplace(index, std::move(folder));
}

bool Execution::finish(const Ended& ended) {
  const PlannedRun& run = plan_.runs[ended.key];
  RunFolder& folder = working_.at(ended.key);
  std::string failure;
  if (ended.end.code == 0 && folder.holds_a_complete_run()) {
    folder.finish(plan_, run, {ended.seconds, launch_.threads});
  } else {
    failure = failure_message(folder.log(), ended);
    if (ended.end.code == kInterrupted && failure.starts_with("interrupted")) return false;
    folder.fail(plan_, run, {failure, ended.end.code});
  }
  working_.erase(ended.key);
  watcher_.on_run(run, failure);
  return true;
}

}  // namespace

Watcher::~Watcher() = default;

bool execute(const StudyFolder& folder, const Plan& plan, const std::vector<std::size_t>& runs,
             const Launch& launch, Watcher& watcher) {
  return Execution(folder, plan, runs, launch, watcher).work();
}

}  // namespace hypotrack::study::internal
