#include "run/results.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

namespace hypotrack::internal {

Results::Results(OpenedScene& scene, std::unique_ptr<FixedLagSmoother> smoother,
                 const std::string& backend, const std::filesystem::path& folder,
                 RunWatcher& watcher)
    : watcher_(watcher),
      backend_(backend),
      smooths_(smoother != nullptr),
      traces_(scene.output.trace),
      output_(*scene.scene, scene.source->cameras(),
              {.directory = folder,
               .worst_frames = scene.output.worst_frames,
               .frame_rate = scene.source->frame_rate(),
               .resolved = scene.resolved,
               .backend = backend,
               .fixed_lag = smooths_,
               .notes = scene.plugin_notes,
               .term_times = scene.term_times},
              std::move(scene.outputs)),
      queue_(output_),
      frames_(*scene.scene, std::move(smoother), queue_) {}

void Results::add_device_error(const std::string& error) {
  output_.set_backend(fmt::format("{}, then the CPU after: {}", backend_, error));
}

std::optional<Summary> Results::finish(bool complete, const ClockTimes& clock) {
  if (output_.empty()) return std::nullopt;
  try {
    Summary summary = output_.finish(complete, clock);
    if (output_.folder().moved())
      watcher_.say(fmt::format("note: the folder of the results was renamed: it is {} now",
                               folder().string()));
    return summary;
  } catch (...) {
    tell_of_frames();
    throw;
  }
}

void Results::tell_of_frames() {
  if (output_.empty() || !output_.folder().exists()) return;
  watcher_.say(
      fmt::format("the frames so far are in {}; the run counts as unfinished", folder().string()));
}

void Results::finish_after_error(const ClockTimes& clock) {
  try {
    frames_.finish_unchanged();
    queue_.settle();
    if (output_.empty()) return;
    output_.finish(false, clock);
    watcher_.say(fmt::format("the run ends early; {} holds the frames so far", folder().string()));
  } catch (const std::exception& e) {
    watcher_.say(e.what());
  }
}

}  // namespace hypotrack::internal
