#include "lab/bench/measure.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "cost/cuda/device.hpp"
#include "lab/bench/frames.hpp"
#include "output/evaluate/true_landmarks.hpp"
#include "output/run/metrics_output.hpp"
#include "session/opened_scene.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack::bench::internal {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A scene that is ready to be tracked in one configuration.
struct Opened {
  OpenedScene session;
  SceneTracker tracker;

  Opened(OpenedScene opened, const Frame& first)
      : session(std::move(opened)),
        tracker(*session.scene, std::move(session.parts), initial_state(session, first),
                session.seed) {
    session.source.reset();  // its frames were read, and it may hold a device
    tracker.check(first);
  }
};

OpenedScene open(const Case& c, const Configuration& configuration, PluginLoader& plugins) {
  std::vector<std::string> overrides = c.overrides;
  overrides.insert(overrides.end(), configuration.overrides.begin(), configuration.overrides.end());
  enter_directory(c);
  return open_scene(c.file, overrides, plugins);
}

/// Measures how much a GPU's free memory has shrunk since construction.
class DeviceMemory {
 public:
  explicit DeviceMemory(int device) : device_(device), free_(cuda::free_memory(device)) {}
  std::optional<double> used_mib() const {
    const auto now = free_ ? cuda::free_memory(device_) : std::nullopt;
    if (!now) return std::nullopt;
    return (static_cast<double>(*free_) - static_cast<double>(*now)) / (1 << 20);
  }

 private:
  int device_;
  std::optional<std::size_t> free_;
};

int usable_of(const std::vector<Frame>& frames) {
  return static_cast<int>(std::count_if(frames.begin(), frames.end(),
                                        [](const Frame& frame) { return !frame.views.empty(); }));
}

/// Profiles frames, if asked to.
class FrameProfiler {
 public:
  FrameProfiler(bool is_on, const Opened& opened) {
    if (!is_on) return;
    const bool on_gpu = !opened.tracker.backend().starts_with("cpu");
    profile_.emplace(on_gpu ? [] { cuda::wait_for_device(); } : std::function<void()>());
    scope_.emplace(*profile_);
  }
  void forget() {
    if (profile_) profile_->clear();
  }
  std::vector<Profile::Part> parts() const {
    return profile_ ? profile_->parts() : std::vector<Profile::Part>();
  }

 private:
  std::optional<Profile> profile_;
  std::optional<ProfileScope> scope_;
};

void track(Opened& opened, const std::vector<Frame>& frames, const Limits& limits, bool profiles,
           const std::function<bool()>& again, Measurement& result) {
  const Scene& scene = *opened.session.scene;
  MetricsCollector metrics(landmark_layout(scene.landmark_names()));
  Schedule schedule(limits, usable_of(frames));
  FrameProfiler profiler(profiles, opened);
  const auto begin = Clock::now();
  for (const Frame& frame : frames) {
    if (!schedule.goes_on(seconds_since(begin)) || !again()) break;
    const auto frame_begin = Clock::now();
    const Solution solution = opened.tracker.track(frame);
    const double seconds = seconds_since(frame_begin);
    if (solution.status == Status::missing) continue;
    if (!schedule.counts(seconds_since(begin))) {
      ++result.warm_up;
      profiler.forget();
      continue;
    }
    result.seconds.push_back(seconds);
    result.evaluations.push_back(static_cast<double>(solution.evaluations));
    metrics.add(frame.index, frame.time, statuses_of(scene, solution),
                scene.landmarks(solution.state),
                true_landmarks(scene, frame).value_or(Eigen::Matrix3Xd()),
                frame.truth ? frame.truth->absent : std::vector<bool>());
  }
  result.metrics = metrics.metrics();
  result.parts = profiler.parts();
}

/// Returns the message of the exception being handled.
std::string current_message() {
  try {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "a plugin threw something that is no std::exception";
  }
}

}  // namespace

std::string_view to_string(Outcome outcome) {
  if (outcome == Outcome::measured) return "measured";
  return outcome == Outcome::unavailable ? "unavailable" : "failed";
}

Measurement measure(const Case& c, const Configuration& configuration, std::vector<Frame>& frames,
                    PluginLoader& plugins, const Limits& limits, bool profiles,
                    const std::function<bool()>& again) {
  Measurement result{.outcome = Outcome::unavailable};
  try {
    OpenedScene session = open(c, configuration, plugins);
    renew_images(frames);
    const DeviceMemory memory(session.parts.evaluate.device);
    Opened opened(std::move(session), frames.front());
    result.device = opened.tracker.backend();
    result.outcome = Outcome::failed;
    track(opened, frames, limits, profiles, again, result);
    result.device_mib = memory.used_mib();
    result.outcome = Outcome::measured;
  } catch (...) {
    result.message = current_message();
    result.seconds.clear();
  }
  return result;
}

}  // namespace hypotrack::bench::internal
