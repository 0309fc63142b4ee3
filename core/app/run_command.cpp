#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/session.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "run/run_scene.hpp"
#include "run_viewers.hpp"
#include "tell.hpp"
#include "viewing/live_run.hpp"

namespace hypotrack::app {
namespace {

struct RunCommand {
  SceneOptions scene;
  RunOptions options{.out = "out", .frames = {}, .stop_now = InterruptGuard::signalled};
  std::optional<std::int64_t> seed;
  bool trace = false;
  ViewerOptions viewers;
};

/// Prints how right the statuses were and how models were recovered, if known.
void print_status(const StatusMetrics& s) {
  if (!std::isnan(s.false_tracked_share))
    fmt::print("tracked: {:.2f} % of these frames are off by more than {:.0f} mm or show nothing\n",
               100 * s.false_tracked_share, kFalseErrorMm);
  if (!std::isnan(s.right_tracked_share))
    fmt::print("within {:.0f} mm: {:.1f} % of these frames are tracked\n", kRightErrorMm,
               100 * s.right_tracked_share);
  if (s.returns > 0)
    fmt::print("{} returns: {:.0f} % recovered within 2 frames, {:.0f} % within 10\n", s.returns,
               100 * s.recovered_2_share, 100 * s.recovered_10_share);
}

void print_summary(const Summary& s, const std::filesystem::path& out) {
  const Metrics& m = s.metrics;
  fmt::print(
      "{} frames ({} tracked, {} uncertain, {} lost, {} absent, {} missing) at {:.1f} fps ({:.1f} "
      "by "
      "the clock), {:.0f} evaluations/s, {}\n",
      m.frames, m.status.tracked_frames, m.status.uncertain_frames, m.status.said_lost_frames,
      m.status.absent_frames, m.missing_frames, s.fps, clock_fps(s), s.evaluations_per_second,
      s.backend);
  if (m.evaluated_frames > 0)
    fmt::print(
        "joint error: mean {:.2f} mm, median {:.2f} mm, 95 % below {:.2f} mm, {:.1f} % of the "
        "frames below 10 mm\n",
        m.mean_error_mm, m.median_error_mm, m.p95_error_mm, 100 * m.success_curve[10]);
  print_status(m.status);
  if (s.mean_sigma) fmt::print("sigma: mean {:.2f} mm", 1000 * *s.mean_sigma);
  if (s.reliability.count() > 0)
    fmt::print(", {:.0f} % of the landmarks within one, {:.0f} % within two, {:.0f} % within three",
               100 * s.reliability.within(1), 100 * s.reliability.within(2),
               100 * s.reliability.within(3));
  if (s.mean_sigma) fmt::print("\n");
  fmt::print("results in {}\n", out.string());
}

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

int run(const RunCommand& command, const CommonOptions& common) {
  std::vector<std::string> overrides = command.scene.set;
  if (command.seed) overrides.push_back(fmt::format("seed={}", *command.seed));
  if (command.trace) overrides.emplace_back("output.trace=true");
  PluginLoader plugins(common.plugin_path);
  Console console(command.options.out);
  open_viewers(command.viewers, console.live());
  const RunResult result = run_scene(command.scene.scene, overrides, plugins, command.options,
                                     console, console.live().additions());
  if (!result.summary) {
    tell("hypotrack: interrupted before the first frame; nothing was written\n");
    return kInterruptedExitCode;
  }
  print_summary(*result.summary, result.folder);
  if (result.complete) return 0;
  tell("hypotrack: interrupted; the files hold the frames so far\n");
  return kInterruptedExitCode;
}

}  // namespace

void add_run_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto given = std::make_shared<RunCommand>();
  const Command command = root.add_command("run", "Track a scene and write the results");
  add_scene_options(command, given->scene);
  command.add("--out", &given->options.out, "Folder for the results",
              {.show_default = true, .check = file_name()});
  command.add("--frames", &given->options.frames, "Stop after this many frames",
              {.check = whole_number(1)});
  command.add("--seed", &given->seed, "Seed of all random numbers",
              {.check = whole_number(0, std::numeric_limits<std::int64_t>::max())});
  command.add("--trace", &given->trace,
              "Write trace.csv: how the searches of every frame converge");
  add_viewer_options(command, given->viewers);
  command.on_call([=, &common, &exit_code] { exit_code = run(*given, common); });
}

}  // namespace hypotrack::app
