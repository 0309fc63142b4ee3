#include "running/run_several.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include "base/machine.hpp"
#include "cost/cuda/device.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "progress.hpp"
#include "run/crew/crew.hpp"
#include "session/scene_file.hpp"

namespace hypotrack::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPoll{5};
constexpr std::chrono::seconds kSilence{3};  // in which runs end after an interrupt without a word

/// Returns the name of a run's folder: the scene's, or that of its folder if it is `scene.yaml`.
std::string name_of(const std::filesystem::path& scene) {
  const std::filesystem::path file = std::filesystem::absolute(scene).lexically_normal();
  const std::string folder = file.parent_path().filename().string();
  return file.stem() == "scene" && !folder.empty() ? folder : file.stem().string();
}

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& scenes,
                                  const std::filesystem::path& out) {
  std::map<std::string, std::filesystem::path> known;
  std::vector<std::string> names;
  for (const auto& scene : scenes) {
    names.push_back(name_of(scene));
    const auto [at, is_new] = known.emplace(names.back(), scene);
    if (!is_new)
      throw ConfigError(fmt::format(
          "{} and {} would both write into {}; rename one, or run it with another --out",
          at->second.string(), scene.string(), (out / names.back()).string()));
  }
  return names;
}

/// Returns the number of the GPU that a scene may take. `chosen`: GPUs were chosen for all.
std::optional<int> gpu_of(const std::filesystem::path& scene, const std::vector<std::string>& set,
                          bool chosen) {
  const EvaluateSettings settings = load_scene(scene, set).file.evaluate;
  const bool wants = settings.backend == Backend::cuda || settings.backend == Backend::automatic;
  if (!wants || (!chosen && !cuda::why_no_device(settings.device).empty())) return std::nullopt;
  return settings.device;
}

/// Returns what a run said besides its progress, its summary and that it was interrupted.
std::string notes_in(std::string log, const std::string& summary) {
  log.erase(log.rfind(summary), summary.size());
  std::string notes;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && !Progress::shows(line) && !line.ends_with(kInterruptedLate))
      notes += "\n" + line;
  return notes;
}

class SeveralScenes {
 public:
  SeveralScenes(const SeveralRuns& runs, const CommonOptions& common)
      : runs_(runs),
        names_(names_of(runs.scenes, runs.out)),
        list_(runs.gpus ? std::optional(parse_gpus(*runs.gpus)) : std::nullopt),
        crew_(settings(common)) {
    for (std::size_t i = 0; i < runs.scenes.size(); ++i) jobs_.push_back(job(i));
  }

  int make() {
    if (list_) tell("on {}\n", crew_.start_gpus(list_->all_needed));
    progress_.emplace(static_cast<int>(jobs_.size()), Progress::Unit::runs);
    std::size_t next = 0;
    while (crew_.size() > 0 || (next < jobs_.size() && !interrupted_)) {
      look_for_interrupt();
      const bool starts = next < jobs_.size() && !interrupted_ && crew_.has_room();
      if (starts) {
        running_.insert(next);
        crew_.start(jobs_[next++]);
      }
      const auto ended = crew_.take_ended();
      for (const std::string& note : crew_.take_notes()) progress_->say(note);
      if (ended) finish(*ended);
      if (!starts && !ended) std::this_thread::sleep_for(kPoll);
    }
    progress_.reset();
    for (; next < jobs_.size(); ++next) not_begun_.insert(next);
    return conclude();
  }

 private:
  CrewSettings settings(const CommonOptions& common) const {
    CrewSettings settings{.program = std::filesystem::read_symlink("/proc/self/exe")};
    for (const auto& folder : common.plugin_path)
      settings.plugin_path.push_back(std::filesystem::absolute(folder));
    if (list_) settings.gpus = list_->numbers;
    settings.jobs = runs_.jobs.value_or(std::max(1, static_cast<int>(settings.gpus.size())));
    if (settings.jobs > 1) settings.variables = driver_variables(threads(settings.jobs));
    return settings;
  }

  static int threads(int jobs) { return std::max(1, core_count() / jobs); }

  Job job(std::size_t index) const {
    Job job{.key = index, .scene = runs_.scenes[index]};
    if (crew_.settings().jobs > 1)
      job.set.push_back(fmt::format("evaluate.threads={}", threads(crew_.settings().jobs)));
    job.set.insert(job.set.end(), runs_.set.begin(), runs_.set.end());
    job.out = runs_.out / names_[index];
    job.log = crew_.scratch() / fmt::format("{}.txt", index);
    job.frames = runs_.frames;
    job.gpu = gpu_of(job.scene, job.set, list_.has_value());
    return job;
  }

  void look_for_interrupt() {
    if (!interrupted_ && interrupt_.interrupted()) {
      interrupted_ = Clock::now();
      crew_.interrupt();
    }
    if (!interrupted_ || said_that_it_waits_ || Clock::now() - *interrupted_ < kSilence) return;
    said_that_it_waits_ = true;
    progress_->say(fmt::format("waiting for {}; Ctrl-C again ends {} at once", names(running_),
                               running_.size() == 1 ? "it" : "them"));
  }

  void finish(const Ended& ended) {
    const std::string& name = names_[ended.key];
    const std::string log = read_whole(jobs_[ended.key].log).value_or("");
    const std::string summary = summary_in(log);
    running_.erase(ended.key);
    if (!summary.empty()) {
      if (const std::string notes = notes_in(log, summary); !notes.empty())
        progress_->say(fmt::format("{}:{}", name, notes));
      progress_->print(fmt::format("{}:\n{}", name, summary));
    }
    if (interrupted_ && log.find(kInterruptedLate) != std::string::npos) {
      cut_.insert(ended.key);
    } else if (interrupted_ && never_began(ended, log)) {
      not_begun_.insert(ended.key);
    } else if (ended.end.code != 0 || summary.empty()) {
      failed_.push_back(name);
      progress_->say(
          fmt::format("failed: {}: {}", name, failure_message(jobs_[ended.key].log, ended)));
    }
    progress_->advance(failed_.empty() ? "" : fmt::format("{} failed", failed_.size()));
  }

  static bool never_began(const Ended& ended, const std::string& log) {
    return log.find("interrupted before the first frame") != std::string::npos ||
           (log.empty() && ended.end.signal == SIGINT);
  }

  std::string names(const std::set<std::size_t>& keys) const {
    std::string text;
    for (const std::size_t key : keys) text += (text.empty() ? "" : ", ") + names_[key];
    return text;
  }

  int conclude() const {
    if (!failed_.empty())
      tell("hypotrack: {} of {} runs failed: {}\n", failed_.size(), jobs_.size(),
           fmt::join(failed_, ", "));
    if (interrupted_) {
      std::string text = "interrupted";
      if (!cut_.empty())
        text += fmt::format("; the files of {} hold the frames so far", names(cut_));
      if (!not_begun_.empty()) text += fmt::format("; {} did not begin", names(not_begun_));
      tell("hypotrack: {}\n", text);
      return kInterruptedExitCode;
    }
    return failed_.empty() ? 0 : 1;
  }

  const SeveralRuns& runs_;
  std::vector<std::string> names_;
  std::optional<GpuList> list_;
  Crew crew_;
  std::vector<Job> jobs_;
  const InterruptGuard interrupt_;
  std::optional<Progress> progress_;
  std::set<std::size_t> running_;
  std::set<std::size_t> cut_;        ///< ended early by an interrupt
  std::set<std::size_t> not_begun_;  ///< because of an interrupt
  std::vector<std::string> failed_;
  std::optional<Clock::time_point> interrupted_;
  bool said_that_it_waits_ = false;
};

}  // namespace

int run_several(const SeveralRuns& runs, const CommonOptions& common) {
  return SeveralScenes(runs, common).make();
}

}  // namespace hypotrack::app
