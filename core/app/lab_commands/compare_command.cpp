#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/machine.hpp"
#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "interrupt.hpp"
#include "lab/study/execute.hpp"
#include "lab/study/plan.hpp"
#include "lab/study/recordings.hpp"
#include "lab/study/results.hpp"
#include "lab/study/study_file.hpp"
#include "lab/study/study_folder.hpp"
#include "messages.hpp"
#include "progress.hpp"
#include "run/crew/crew.hpp"

namespace hypotrack::app {
namespace {

/// Exit code of a complete study with failed runs.
constexpr int kFailedRunsExitCode = 3;

struct CompareOptions {
  std::filesystem::path study, out;
  std::optional<std::string> variant;
  int jobs = 0, threads = 0;
  double time_limit_s = 0;
  std::string shard = "1/1";
  bool retry_failed = false;
  std::optional<std::string> gpus;
  std::string pictures = "png";
};

std::optional<std::size_t> parse_count(std::string_view text) {
  std::size_t count = 0;
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, count);
  if (error != std::errc() || at != end || count == 0) return std::nullopt;
  return count;
}

study::Shard parse_shard(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto index = parse_count(text.substr(0, slash));
  const auto count =
      slash < text.size() ? parse_count(text.substr(slash + 1)) : std::optional<std::size_t>();
  if (!index || !count || *index > *count)
    throw ConfigError(
        fmt::format("--shard {}: expected i/n with i from 1 to n, for example 1/4 to 4/4", text));
  return {*index - 1, *count};
}

study::Launch launch_of(const CompareOptions& options, const CommonOptions& common) {
  study::Launch launch;
  launch.program = std::filesystem::read_symlink("/proc/self/exe");
  for (const auto& folder : common.plugin_path)
    launch.plugin_path.push_back(std::filesystem::absolute(folder));
  launch.time_limit_s = options.time_limit_s;
  launch.pictures = options.pictures;
  const int cores = core_count();
  launch.jobs = options.jobs > 0 ? options.jobs : cores;
  // A run on a GPU has threads of its own that read and write, too.
  const int per_run = cores / (options.gpus ? 2 * launch.jobs : launch.jobs);
  launch.threads = options.threads > 0 ? options.threads : std::max(1, per_run);
  launch.spare_cores = std::max(0, cores - launch.jobs * launch.threads);
  return launch;
}

/// Shows the progress and ends the work on Ctrl-C.
class Console : public study::Watcher {
 public:
  Console(const study::Plan& plan, std::size_t runs, const InterruptGuard& interrupt)
      : plan_(plan),
        interrupt_(interrupt),
        progress_(static_cast<int>(runs), Progress::Unit::runs) {}

  bool stop() override { return interrupt_.interrupted(); }
  void say(const std::string& text) override { progress_.say(text); }

  void on_run(const study::PlannedRun& run, const std::string& failure) override {
    if (!failure.empty()) {
      ++failed_;
      progress_.say(fmt::format("failed: {}, seed {}: {}", plan_.describe(plan_.cells[run.cell]),
                                run.seed, failure));
    }
    progress_.advance(failed_ > 0 ? fmt::format("{} failed", failed_) : "");
  }

 private:
  const study::Plan& plan_;
  const InterruptGuard& interrupt_;
  Progress progress_;
  int failed_ = 0;
};

/// Returns the runs of the shard that are not made yet.
std::vector<std::size_t> runs_to_make(const study::StudyFolder& folder, const study::Plan& plan,
                                      const CompareOptions& options) {
  std::vector<std::size_t> runs = study::runs_of(plan, parse_shard(options.shard));
  std::erase_if(runs, [&](std::size_t run) {
    const study::RunState state = folder.state(plan.runs[run]);
    return state == study::RunState::ok ||
           (state == study::RunState::failed && !options.retry_failed);
  });
  return runs;
}

std::vector<std::size_t> cells_of(const study::Plan& plan, const std::vector<std::size_t>& runs) {
  std::set<std::size_t> cells;
  for (const std::size_t run : runs) cells.insert(plan.runs[run].cell);
  return {cells.begin(), cells.end()};
}

/// Returns the cells to check before anything runs: all of a new study, later those with runs to
/// make.
std::vector<std::size_t> cells_to_check(const study::StudyFolder& folder, const study::Plan& plan,
                                        const std::vector<std::size_t>& runs) {
  std::vector<std::size_t> cells(plan.cells.size());
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  if (!folder.begun()) return cells;
  return cells_of(plan, runs);
}

/// Prints the state of the study and returns the exit code.
int conclude(const study::Tally& tally, const study::StudyFolder& folder, bool complete) {
  const std::size_t failed = tally.failed;
  fmt::print("{} of {} runs are there, {} failed; tables in {}\n", tally.ok + failed, tally.planned,
             failed, folder.path().string());
  if (!complete) {
    tell("hypotrack: interrupted; the same command goes on from here\n");
    return kInterruptedExitCode;
  }
  if (failed > 0)
    tell("hypotrack: {} run{} failed, results.csv says why; --retry-failed makes {} again\n",
         failed, failed == 1 ? "" : "s", failed == 1 ? "it" : "them");
  return failed > 0 ? kFailedRunsExitCode : 0;
}

int compare(const CompareOptions& options, const CommonOptions& common) {
  const study::Plan plan = study::make_plan(study::load_study(options.study, options.variant));
  const study::StudyFolder folder(options.out, plan);
  const std::vector<std::size_t> runs = runs_to_make(folder, plan, options);
  const auto list = options.gpus ? std::optional(parse_gpus(*options.gpus)) : std::nullopt;
  study::Launch launch = launch_of(options, common);
  if (list) launch.gpus = list->numbers;
  const InterruptGuard interrupt;
  Crew crew(study::crew_settings(launch, plan));
  if (list && !runs.empty()) {
    tell("on {}\n", crew.start_gpus(list->all_needed));
    launch.gpus = crew.settings().gpus;
  }
  const std::vector<std::size_t> cells = cells_to_check(folder, plan, runs);
  tell("{}: {} runs in {} cells, {} to make here; {} at a time, {} thread{} each\n",
       plan.study.title, plan.runs.size(), plan.cells.size(), runs.size(), launch.jobs,
       launch.threads, launch.threads == 1 ? "" : "s");
  study::Recordings recordings(folder, plan, runs, launch);
  study::RecordingsAhead ahead(folder, recordings, runs, launch);
  const auto gpus = study::check_cells(plan, cells, launch, crew, [&] {
    ahead.go_on();
    return !interrupt.interrupted();
  });
  if (interrupt.interrupted()) {
    tell("hypotrack: interrupted before the first run\n");
    return kInterruptedExitCode;
  }
  ahead.keep();
  folder.begin();
  Console console(plan, runs.size(), interrupt);
  const bool complete = study::execute(folder, plan, runs, launch, gpus, crew, recordings, console);
  return conclude(study::write_tables(folder, plan), folder, complete);
}

}  // namespace

void add_compare_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  const Command command =
      root.add_command("compare", "Run a study: scenes, settings and seeds, and tabulate it");
  command.add("study", &options->study, "Study file (YAML)", {.required = true});
  command.add("--out", &options->out, "Folder for runs and tables",
              {.required = true, .check = file_name()});
  command.add("--variant", &options->variant, "Variant of the study, for example quick");
  command.add("--jobs", &options->jobs, "Runs at a time (default: one per core)",
              {.check = whole_number(1)});
  command.add("--threads", &options->threads,
              "Threads of each run (default: cores / jobs, half of that on GPUs)",
              {.check = whole_number(1)});
  command.add("--gpus", &options->gpus,
              "GPUs to share the runs among: all, auto (all that answer), or numbers as 0,2");
  command.add("--pictures", &options->pictures,
              "Format of the study's recordings: png, or ppm, which is larger and read at once",
              {.show_default = true, .check = one_of({"png", "ppm"})});
  command.add("--shard", &options->shard,
              "Make a part of the runs: i/n, for one of n machines that share the folder");
  command.add("--time-limit", &options->time_limit_s,
              "Seconds after which a run, or its check, is ended and fails (default: none)",
              {.check = positive_number()});
  command.add("--retry-failed", &options->retry_failed, "Make failed runs again");
  command.on_call([=, &common, &exit_code] { exit_code = compare(*options, common); });
}

}  // namespace hypotrack::app
