#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "commands.hpp"
#include "hypotrack/error.hpp"
#include "interrupt.hpp"
#include "output/run_output.hpp"
#include "progress.hpp"
#include "session/session.hpp"

namespace hypotrack::app {
namespace {

struct RunOptions {
  SceneOptions scene;
  std::filesystem::path out = "out";
  std::optional<int> frames;
  std::optional<std::int64_t> seed;
};

/// The first frame that can be used; those before it are counted and reported.
Frame first_usable_frame(Source& source, std::vector<Frame>& unusable) {
  while (auto frame = source.next()) {
    if (!frame->views.empty()) return *std::move(frame);
    fmt::print(stderr, "frame {}: {}\n", frame->index, frame->problem);
    unusable.push_back(*std::move(frame));
  }
  throw DataError("the source has no usable frame");
}

void print_summary(const Summary& s, const std::filesystem::path& out) {
  fmt::print(
      "{} frames ({} lost, {} uncertain, {} missing) at {:.1f} fps, {:.0f} evaluations/s, {}\n",
      s.frames, s.lost_frames, s.uncertain_frames, s.missing_frames, s.fps,
      s.evaluations_per_second, s.backend);
  if (s.errors)
    fmt::print("joint error: mean {:.2f} mm, median {:.2f} mm, {:.1f} % below 10 mm\n",
               s.errors->mean, s.errors->median, 100 * s.errors->fraction_below[1]);
  fmt::print("results in {}\n", out.string());
}

std::string note_of(const Solution& solution, double error) {
  std::string note(to_string(solution.status));
  if (!std::isnan(error)) note += fmt::format(", {:.1f} mm", 1000 * error);
  return note;
}

/// Tracks until the source ends, `frames` are done or the user interrupts; true in the first two
/// cases.
bool track_all(Session& session, Tracker& tracker, RunOutput& output, const Frame& first,
               std::optional<int> frames) {
  std::optional<int> total = session.source->frame_count();
  if (frames) total = total ? std::min(*total, *frames) : *frames;
  InterruptGuard interrupt;
  Progress progress(total);
  std::optional<Frame> frame = first;
  for (int done = 0; frame; ++done) {
    if (frames && done >= *frames) return true;
    if (!frame->problem.empty()) fmt::print(stderr, "frame {}: {}\n", frame->index, frame->problem);
    const Solution solution = tracker.track(*frame);
    progress.advance(note_of(solution, output.add(*frame, solution)));
    if (interrupt.interrupted()) return false;
    frame = session.source->next();
  }
  return true;
}

int run(const RunOptions& options, const CommonOptions& common) {
  std::vector<std::string> overrides = options.scene.set;
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  PluginLoader plugins(common.plugin_path);
  Session session = open_session(options.scene.scene, overrides, plugins);
  std::vector<Frame> unusable;
  const Frame first = first_usable_frame(*session.source, unusable);
  Tracker tracker(*session.scene, std::move(session.parts), initial_state(session, first),
                  session.seed);
  RunOutput output(*session.scene, session.source->cameras().front(),
                   {.directory = options.out,
                    .overlay = session.output.overlay,
                    .frame_rate = session.source->frame_rate(),
                    .resolved = session.resolved,
                    .backend = tracker.backend()});
  fmt::print(stderr, "tracking with {}\n", tracker.backend());
  for (const Frame& frame : unusable) output.add(frame, tracker.track(frame));
  bool complete = false;
  try {
    complete = track_all(session, tracker, output, first, options.frames);
  } catch (const OutputError&) {
    throw;  // the files cannot be finished either
  } catch (...) {
    output.finish(false);  // what was tracked so far is kept
    throw;
  }
  print_summary(output.finish(complete), options.out);
  if (complete) return 0;
  fmt::print(stderr, "hypotrack: interrupted; the files hold the frames so far\n");
  return kInterruptedExitCode;
}

}  // namespace

void add_run_command(CLI::App& app, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Track a scene and write the results");
  add_scene_options(*command, options->scene);
  command->add_option("--out", options->out, "Folder for the results")->capture_default_str();
  command->add_option("--frames", options->frames, "Stop after this many frames")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed, "Seed of all random numbers")
      ->check(CLI::NonNegativeNumber);
  command->callback([=, &common, &exit_code] { exit_code = run(*options, common); });
}

}  // namespace hypotrack::app
