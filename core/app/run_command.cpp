#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/session.hpp"
#include "interrupt.hpp"
#include "lab/live/live_view.hpp"
#include "progress.hpp"
#include "run/run_scene.hpp"
#include "tell.hpp"

namespace hypotrack::app {
namespace {

struct RunCommand {
  SceneOptions scene;
  RunOptions options{.out = "out", .frames = {}};
  std::optional<std::int64_t> seed;
  std::optional<int> web_port;
  LiveViewOptions web;
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

/// Shows the progress of a run and ends it on Ctrl-C.
class Console final : public RunWatcher {
 public:
  /// `web`: a live view that shows the run as well; may be null.
  explicit Console(LiveView* web) : web_(web) {}

  bool stop() override {
    if (web_) web_->wait_while_paused([this] { return interrupt_.interrupted(); });
    return interrupt_.interrupted();
  }
  void say(const std::string& text) override {
    if (progress_)
      progress_->say(text);
    else
      tell("{}\n", text);
  }
  void begin(std::optional<int> frames) override {
    progress_.emplace(frames);
    if (web_) web_->begin(frames);
  }
  void frame(const Frame& frame, const Solution& solution, double error) override {
    if (!frame.problem.empty()) say(fmt::format("frame {}: {}", frame.index, frame.problem));
    std::string note(to_string(solution.status));
    if (!std::isnan(error)) note += fmt::format(", {:.1f} mm", 1000 * error);
    progress_->advance(note);
    if (web_) web_->frame(frame, solution, error);
  }
  void end() override { progress_.reset(); }

 private:
  InterruptGuard interrupt_;
  std::optional<Progress> progress_;
  LiveView* web_;
};

/// Opens the live view if it is wanted, and says where it is.
std::unique_ptr<LiveView> open_web(const RunCommand& command) {
  const bool has_rules = !command.web.token.empty() || command.web.host != LiveViewOptions().host;
  if (!command.web_port && has_rules)
    throw ConfigError("--web-host and --web-token belong to a live view; give --web PORT, too");
  if (!command.web_port) return nullptr;
  LiveViewOptions options = command.web;
  options.port = *command.web_port;
  std::unique_ptr<LiveView> web = open_live_view(options);
  tell("live view: {}\n", web->address());
  return web;
}

int run(const RunCommand& command, const CommonOptions& common) {
  std::vector<std::string> overrides = command.scene.set;
  if (command.seed) overrides.push_back(fmt::format("seed={}", *command.seed));
  PluginLoader plugins(common.plugin_path);
  const std::unique_ptr<LiveView> web = open_web(command);
  RunAdditions additions;
  if (web) {
    additions.outputs.push_back({"live view", web->output()});
    additions.searches_anew = [&web] { return web->take_restart(); };
  }
  Console console(web.get());
  const RunResult result = run_scene(command.scene.scene, overrides, plugins, command.options,
                                     console, std::move(additions));
  if (!result.summary) {
    tell("hypotrack: interrupted before the first frame; nothing was written\n");
    return kInterruptedExitCode;
  }
  print_summary(*result.summary, command.options.out);
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
  command.add("--web", &given->web_port, "Show the run as a web page on this port; 0: any free one",
              {.check = whole_number(0, 65535), .if_bare = "8080"});
  command.add("--web-host", &given->web.host, "Address at which others reach the page",
              {.show_default = true, .check = file_name()});
  command.add("--web-token", &given->web.token, "Secret word that the page's address needs");
  command.on_call([=, &common, &exit_code] { exit_code = run(*given, common); });
}

}  // namespace hypotrack::app
