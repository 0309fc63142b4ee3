#include "run/run_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/stop_scope.hpp"
#include "camera/pair_check.hpp"
#include "hypotrack/api/error.hpp"
#include "output/evaluate/true_landmarks.hpp"
#include "run/read_ahead.hpp"
#include "run/results.hpp"
#include "run/run_notes.hpp"
#include "session/opened_scene.hpp"
#include "shape/estimated_scene.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack::internal {
namespace {

/// Asks a watcher whether to stop, and remembers a yes.
class Latch {
 public:
  explicit Latch(RunWatcher& watcher) : watcher_(watcher) {}
  bool stopped() { return stopped_ = stopped_ || watcher_.stop(); }
  /// Stops in the watcher's place, and tells it so by asking. Returns false.
  bool end() {
    stopped();
    stopped_ = true;
    return false;
  }
  RunWatcher& watcher() { return watcher_; }

 private:
  RunWatcher& watcher_;
  bool stopped_ = false;
};

/// Calls a function that searches. Returns false if the test ended it.
template <class Function>
bool completes(const StopTest& stop, const Function& function) {
  const StopScope scope(stop);
  try {
    function();
    return true;
  } catch (const Stopped&) {
    return false;
  }
}

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

/// Opens a scene; estimates the shape from the first seconds if the scene asks for it.
EstimatedScene open_for_run(const SceneInput& scene, std::span<const std::string> overrides,
                            PluginLoader& plugins, Latch& latch) {
  RunWatcher& watcher = latch.watcher();
  const ShapeEstimateSettings shapes = load_scene(scene, overrides).file.shape;
  if (shapes.seconds == 0) {
    EstimatedScene opened;
    opened.scene = open_scene(scene, overrides, plugins);
    return opened;
  }
  ShapeProgress progress;
  progress.begin_round = [&](int round) {
    watcher.say(
        fmt::format("fitting the shape to the first {:g} s, round {} of {}; this takes a "
                    "while",
                    shapes.seconds, round + 1, shapes.rounds));
  };
  progress.stop = [&] { return latch.stopped(); };
  EstimatedScene opened = open_estimated(scene, overrides, plugins, progress);
  if (latch.stopped()) return opened;
  std::string shape;
  for (const ShapeParameter& p : opened.estimate.wanted)
    shape += fmt::format(", {} {:.3f}", p.name, p.value);
  watcher.say(fmt::format("shape from {} frames{}", opened.estimate.used_frames, shape));
  if (shapes.from == ShapeFrom::starters && opened.estimate.used_frames == 0)
    watcher.say(
        fmt::format("warning: no starter saw the models well in the first {:g} s; their sizes are "
                    "those given. Raise shape.estimate_s, or give the scale",
                    shapes.seconds));
  for (const std::string& warning : warnings_of_bounds(opened.estimate))
    watcher.say("warning: " + warning);
  return opened;
}

/// Returns the mean distance of the landmarks from the ground truth, in metres; NaN: unknown.
double error_of(const Scene& scene, const Frame& frame, const Solution& solution) {
  const auto truth = true_landmarks(scene, frame);
  if (!truth || solution.status == Status::missing) return std::numeric_limits<double>::quiet_NaN();
  return frame_error(landmark_layout(scene.landmark_names()), solution.landmarks, *truth).mean;
}

/// Calls begin() and, at the end of its life, end() of a watcher.
class WatchedFrames {
 public:
  WatchedFrames(RunWatcher& watcher, std::optional<int> frames) : watcher_(watcher) {
    watcher_.begin(frames);
  }
  ~WatchedFrames() { watcher_.end(); }
  WatchedFrames(const WatchedFrames&) = delete;
  WatchedFrames& operator=(const WatchedFrames&) = delete;

 private:
  RunWatcher& watcher_;
};

using SteadyClock = std::chrono::steady_clock;

double seconds_since(SteadyClock::time_point begin) {
  return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

/// Tracks `first`, which was read already, and then the rest of the source, as far as the options
/// say. Returns false if they or the watcher ended it. Adds to `clock` how long reading and
/// tracking took.
bool track_all(const Scene& scene, Source& source, SceneTracker& tracker, Results* results,
               const std::vector<Frame>& first, const RunOptions& options, Latch& latch,
               const std::function<bool()>& searches_anew, RunNotes& notes, ClockTimes& clock) {
  const std::optional<int> limit = options.frames;
  RunWatcher& watcher = latch.watcher();
  std::optional<int> total = source.frame_count();
  if (limit) total = total ? std::min(*total, *limit) : *limit;
  const WatchedFrames watched(watcher, total);
  const int read = static_cast<int>(first.size());
  ReadAhead rest(source, limit ? std::optional(*limit - read) : std::nullopt, tracker.threads());
  for (int done = 0; !limit || done < *limit; ++done) {
    if (latch.stopped()) return false;
    if (searches_anew && searches_anew()) tracker.search_anew();
    const std::optional<Frame> frame =
        done < read ? first[static_cast<std::size_t>(done)] : rest.next();
    clock.reading = rest.seconds();
    if (!frame) break;
    std::optional<SearchRecord> record;
    if (results && results->want_search(*frame)) record.emplace();
    std::optional<FrameTrace> trace;
    if (results && results->traces()) trace.emplace();
    const auto begin = SteadyClock::now();
    Solution solution;
    if (!completes(options.stop_now, [&] {
          solution = tracker.track(*frame, record ? &*record : nullptr, trace ? &*trace : nullptr);
        }))
      return latch.end();
    clock.tracking += seconds_since(begin);
    if (record) results->add_search(*frame, solution, *std::move(record));
    if (trace) results->add_trace(frame->index, *trace);
    if (results) results->add(tracker, *frame, solution);
    notes.add(solution, clock);
    const bool smooths = results && results->smooths();
    watcher.frame(
        *frame, solution,
        smooths ? std::numeric_limits<double>::quiet_NaN() : error_of(scene, *frame, solution));
  }
  return true;
}

void say_statistics(const Source& source, RunWatcher& watcher) {
  for (const std::string& line : source.statistics()) watcher.say(line);
}

/// Throws OutputError if the run's protocol would replace the scene, where no run wrote that.
void spare_scene(const std::filesystem::path& scene, const std::filesystem::path& folder) {
  std::error_code error;
  const bool same = std::filesystem::equivalent(scene, folder / "run.yaml", error);
  if (same && !std::filesystem::exists(folder / "track.csv"))
    throw OutputError(fmt::format(
        "{}: the run would replace this scene by its own run.yaml; name another folder with --out",
        scene.string()));
}

}  // namespace

RunResult run_scene(const SceneInput& scene, std::span<const std::string> overrides,
                    PluginLoader& plugins, const RunOptions& options, RunWatcher& watcher,
                    RunAdditions additions) {
  spare_scene(scene.file(), options.out);
  Latch latch(watcher);
  EstimatedScene estimated;
  if (!completes(options.stop_now,
                 [&] { estimated = open_for_run(scene, overrides, plugins, latch); }))
    latch.end();
  if (latch.stopped()) return {};
  OpenedScene& opened = estimated.scene;
  if (additions.opened) additions.opened(opened);
  std::ranges::move(additions.outputs, std::back_inserter(opened.outputs));
  const std::vector<Frame> first = frames_up_to_a_usable(*opened.source, options.frames);
  if (options.out.empty()) opened.parts.fixed_lag.enabled = false;
  std::unique_ptr<FixedLagSmoother> smoother = make_fixed_lag_smoother(opened);
  const bool given_start = !opened.parts.begins_by_looking;
  SceneTracker tracker(*opened.scene, std::move(opened.parts),
                       initial_state(opened, first.back(), &opened.notes), opened.seed);
  std::unique_ptr<Results> results;
  if (!options.out.empty())
    results = std::make_unique<Results>(opened, std::move(smoother), tracker.backend(), options.out,
                                        watcher);
  watcher.say(fmt::format("tracking with {}", tracker.backend()));
  for (const std::string& note : opened.notes) watcher.say("note: " + note);
  for (const std::string& note : opened.source->notes()) watcher.say("note: " + note);
  for (const std::string& problem :
       {problem_of_pair(opened.source->cameras()), tracker.problem_of_start(first.back())})
    if (!problem.empty()) watcher.say(fmt::format("note: {}", problem));
  RunNotes notes(watcher, tracker, given_start, *opened.plugin_notes, results.get());
  notes.look_at_gpu();
  notes.say_plugin_lines();
  RunResult result;
  ClockTimes clock;
  const auto begin = SteadyClock::now();
  const auto times = [&] {
    clock.total = seconds_since(begin);
    clock.writing = results->writing_seconds();
    return clock;
  };
  try {
    result.complete = track_all(*opened.scene, *opened.source, tracker, results.get(), first,
                                options, latch, additions.searches_anew, notes, clock);
    if (results) results->settle();
    notes.look_at_device("smoothing");
    say_statistics(*opened.source, watcher);
  } catch (const OutputError&) {  // the files cannot be finished either
    if (results) results->tell_of_frames();
    throw;
  } catch (...) {
    if (results) results->finish_after_error(times());
    notes.finish();
    say_statistics(*opened.source, watcher);
    throw;
  }
  if (results) {
    result.summary = results->finish(result.complete, times());
    result.folder = results->folder();
  }
  notes.finish();
  return result;
}

}  // namespace hypotrack::internal
