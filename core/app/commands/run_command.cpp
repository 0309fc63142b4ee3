#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/session.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "interrupt.hpp"
#include "messages.hpp"
#include "progress.hpp"
#include "run/run_scene.hpp"
#include "running/run_several.hpp"
#include "running/run_viewers.hpp"
#include "viewing/live_run.hpp"

namespace hypotrack::app {
namespace {

struct RunCommand {
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> set;
  std::optional<int> jobs;
  std::optional<std::string> gpus;
  RunOptions options{.out = "out", .frames = {}, .stop_now = InterruptGuard::signalled};
  std::optional<std::int64_t> seed;
  bool trace = false;
  ViewerOptions viewers;
};

/// Shows the progress of a run and ends it on Ctrl-C, or when a viewer asks for it.
class Console final : public RunWatcher {
 public:
  /// `folder`: that of the results.
  explicit Console(const std::filesystem::path& folder)
      : live_(folder, [this](const std::string& text) { say(text); }) {}

  LiveRun& live() { return live_; }

  bool stop() override {
    const bool ended = live_.wait_while_paused([this] { return interrupt_.interrupted(); });
    return ended || interrupt_.interrupted();
  }
  void say(const std::string& text) override {
    if (progress_)
      progress_->say(text);
    else
      tell("{}\n", text);
  }
  void begin(std::optional<int> frames) override {
    progress_.emplace(frames);
    live_.begin(frames);
  }
  void frame(const Frame& frame, const Solution& solution, double error) override {
    if (!frame.problem.empty()) say(fmt::format("frame {}: {}", frame.index, frame.problem));
    std::string note(to_string(solution.status));
    if (!std::isnan(error)) note += fmt::format(", {:.1f} mm", 1000 * error);
    progress_->advance(note);
    live_.frame(frame, solution, error);
  }
  void end() override {
    progress_.reset();
    live_.end();
  }

 private:
  InterruptGuard interrupt_;
  std::optional<Progress> progress_;
  LiveRun live_;
};

std::vector<std::string> overrides_of(const RunCommand& command) {
  std::vector<std::string> overrides = command.set;
  if (command.seed) overrides.push_back(fmt::format("seed={}", *command.seed));
  if (command.trace) overrides.emplace_back("output.trace=true");
  return overrides;
}

/// Runs several scenes, without viewers.
int run_all(const RunCommand& command, const CommonOptions& common) {
  if (command.viewers.preview || command.viewers.web_port)
    throw ConfigError(
        "--preview and --web show one run; leave out --jobs and --gpus, and name one "
        "scene");
  return run_several({.scenes = command.scenes,
                      .set = overrides_of(command),
                      .out = command.options.out,
                      .frames = command.options.frames,
                      .jobs = command.jobs,
                      .gpus = command.gpus},
                     common);
}

int run(const RunCommand& command, const CommonOptions& common) {
  if (command.scenes.size() > 1 || command.jobs || command.gpus) return run_all(command, common);
  const std::vector<std::string> overrides = overrides_of(command);
  PluginLoader plugins(common.plugin_path);
  Console console(command.options.out);
  open_viewers(command.viewers, console.live());
  const RunResult result = run_scene(command.scenes.front(), overrides, plugins, command.options,
                                     console, console.live().additions());
  if (!result.summary) {
    tell("hypotrack: {}\n", kInterruptedEarly);
    return kInterruptedExitCode;
  }
  fmt::print("{}", summary_text(*result.summary, result.folder));
  if (result.complete) return 0;
  tell("hypotrack: {}\n", kInterruptedLate);
  return kInterruptedExitCode;
}

}  // namespace

void add_run_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto given = std::make_shared<RunCommand>();
  const Command command =
      root.add_command("run", "Track a scene, or several, and write the results");
  command.add("scene", &given->scenes, "Scene files (YAML)", {.required = true});
  add_set_option(command, given->set);
  command.add("--out", &given->options.out,
              "Folder for the results; of several scenes each has a folder in it",
              {.show_default = true, .check = file_name()});
  command.add("--frames", &given->options.frames, "Stop after this many frames",
              {.check = whole_number(1)});
  command.add("--seed", &given->seed, "Seed of all random numbers",
              {.check = whole_number(0, std::numeric_limits<std::int64_t>::max())});
  command.add("--trace", &given->trace,
              "Write trace.csv: how the searches of every frame converge");
  command.add("--jobs", &given->jobs, "Runs at a time (default: one, or one per GPU of --gpus)",
              {.check = whole_number(1)});
  command.add("--gpus", &given->gpus,
              "GPUs to share the runs among: all, auto (all that answer), or numbers as 0,2");
  add_viewer_options(command, given->viewers);
  command.on_call([=, &common, &exit_code] { exit_code = run(*given, common); });
}

}  // namespace hypotrack::app
