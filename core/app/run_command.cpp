#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "hypotrack/error.hpp"
#include "interrupt.hpp"
#include "notes.hpp"
#include "output/hindsight_output.hpp"
#include "output/run_output.hpp"
#include "progress.hpp"
#include "session/session.hpp"
#include "shape/estimated_session.hpp"
#include "tell.hpp"

namespace hypotrack::app {
namespace {

struct RunOptions {
  SceneOptions scene;
  std::filesystem::path out = "out";
  std::optional<int> frames;
  std::optional<std::int64_t> seed;
};

/// Reads frames up to and including the first usable one. Throws DataError if none of the first
/// `limit` frames is usable.
std::vector<Frame> frames_up_to_a_usable(Source& source, std::optional<int> limit) {
  std::vector<Frame> frames;
  while (!limit || frames.size() < static_cast<std::size_t>(*limit)) {
    auto frame = source.next();
    if (!frame) break;
    frames.push_back(*std::move(frame));
    if (!frames.back().views.empty()) return frames;
  }
  if (frames.empty()) throw DataError("the source has no frame");
  throw DataError(fmt::format("none of the source's {} frames can be used; the first: {}",
                              frames.size(), frames.front().problem));
}

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
      "{} frames ({} tracked, {} uncertain, {} lost, {} absent, {} missing) at {:.1f} fps, {:.0f} "
      "evaluations/s, {}\n",
      m.frames, m.status.tracked_frames, m.status.uncertain_frames, m.status.said_lost_frames,
      m.status.absent_frames, m.missing_frames, s.fps, s.evaluations_per_second, s.backend);
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

std::string note_of(const Solution& solution, double error) {
  std::string note(to_string(solution.status));
  if (!std::isnan(error)) note += fmt::format(", {:.1f} mm", 1000 * error);
  return note;
}

/// Tracks `first`, which was read already, and then the rest of the source. Stops after `limit`
/// frames or on an interrupt. Returns false if interrupted.
bool track_all(Session& session, Tracker& tracker, HindsightOutput& output,
               const std::vector<Frame>& first, std::optional<int> limit,
               const InterruptGuard& interrupt) {
  std::optional<int> total = session.source->frame_count();
  if (limit) total = total ? std::min(*total, *limit) : *limit;
  Progress progress(total);
  for (int done = 0; !limit || done < *limit; ++done) {
    if (interrupt.interrupted()) return false;
    const auto index = static_cast<std::size_t>(done);
    const std::optional<Frame> frame = index < first.size() ? first[index] : session.source->next();
    if (!frame) break;
    if (!frame->problem.empty())
      progress.say(fmt::format("frame {}: {}", frame->index, frame->problem));
    const Solution solution = tracker.track(*frame);
    progress.advance(note_of(solution, output.add(tracker, *frame, solution)));
  }
  return true;
}

/// Says where the unfinished files with the frames so far are.
void tell_of_parts(const RunOutput& output, const std::filesystem::path& out) {
  if (output.empty() || !std::filesystem::exists(out / ".part.track.csv")) return;
  tell("the frames so far are in {}/.part.track.csv and the files beside it\n", out.string());
}

/// Ends a run after an exception, which is being handled. Keeps the frames tracked so far, unless
/// writing them is what failed.
void finish_after_error(HindsightOutput& frames, RunOutput& output,
                        const std::filesystem::path& out) {
  try {
    frames.finish_unchanged();
    if (output.empty()) return;
    output.finish(false);
    tell("hypotrack: the run ends early; {} holds the frames so far\n", out.string());
  } catch (const OutputError& e) {
    tell("hypotrack: {}\n", e.what());
  }
}

/// Opens a scene; estimates the shape from the first seconds if the scene asks for it.
EstimatedSession open_for_run(const RunOptions& options, const std::vector<std::string>& overrides,
                              PluginLoader& plugins, const InterruptGuard& interrupt) {
  const ShapeEstimateSettings shapes = load_scene(options.scene.scene, overrides).file.shape;
  if (shapes.seconds == 0) {
    EstimatedSession opened;
    opened.session = open_session(options.scene.scene, overrides, plugins);
    return opened;
  }
  ShapeProgress progress;
  progress.begin_round = [&](int round) {
    tell("fitting the shape to the first {:g} s, round {} of {}; this takes a while\n",
         shapes.seconds, round + 1, shapes.rounds);
  };
  progress.stop = [&] { return interrupt.interrupted(); };
  EstimatedSession opened = open_estimated(options.scene.scene, overrides, plugins, progress);
  std::string shape;
  for (const ShapeParameter& p : opened.estimate.wanted)
    shape += fmt::format(", {} {:.3f}", p.name, p.value);
  tell("shape from {} frames{}\n", opened.estimate.used_frames, shape);
  return opened;
}

int run(const RunOptions& options, const CommonOptions& common) {
  std::vector<std::string> overrides = options.scene.set;
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  PluginLoader plugins(common.plugin_path);
  const InterruptGuard interrupt;
  EstimatedSession opened = open_for_run(options, overrides, plugins, interrupt);
  if (interrupt.interrupted()) {
    tell("hypotrack: interrupted before the first frame; nothing was written\n");
    return kInterruptedExitCode;
  }
  Session& session = opened.session;
  const std::vector<Frame> first = frames_up_to_a_usable(*session.source, options.frames);
  std::unique_ptr<Hindsight> hindsight = make_hindsight(session);
  Tracker tracker(*session.scene, std::move(session.parts), initial_state(session, first.back()),
                  session.seed);
  RunOutput output(*session.scene, session.source->cameras().front(),
                   {.directory = options.out,
                    .overlay = session.output.overlay,
                    .worst_frames = session.output.worst_frames,
                    .frame_rate = session.source->frame_rate(),
                    .resolved = session.resolved,
                    .backend = tracker.backend(),
                    .hindsight = hindsight != nullptr});
  HindsightOutput frames(std::move(hindsight), output);
  tell("tracking with {}\n", tracker.backend());
  tell_notes(*session.source, tracker, first.back());
  bool complete = false;
  try {
    complete = track_all(session, tracker, frames, first, options.frames, interrupt);
    frames.finish();
  } catch (const OutputError&) {  // the files cannot be finished either
    tell_of_parts(output, options.out);
    throw;
  } catch (...) {
    finish_after_error(frames, output, options.out);
    throw;
  }
  if (output.empty()) {
    tell("hypotrack: interrupted before the first frame; nothing was written\n");
    return kInterruptedExitCode;
  }
  try {
    print_summary(output.finish(complete), options.out);
  } catch (const OutputError&) {
    tell_of_parts(output, options.out);
    throw;
  }
  if (complete) return 0;
  tell("hypotrack: interrupted; the files hold the frames so far\n");
  return kInterruptedExitCode;
}

}  // namespace

void add_run_command(const Command& root, CommonOptions& common, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  const Command command = root.add_command("run", "Track a scene and write the results");
  add_scene_options(command, options->scene);
  command.add("--out", &options->out, "Folder for the results",
              {.show_default = true, .check = file_name()});
  command.add("--frames", &options->frames, "Stop after this many frames",
              {.check = whole_number(1)});
  command.add("--seed", &options->seed, "Seed of all random numbers",
              {.check = whole_number(0, std::numeric_limits<std::int64_t>::max())});
  command.on_call([=, &common, &exit_code] { exit_code = run(*options, common); });
}

}  // namespace hypotrack::app
