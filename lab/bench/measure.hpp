#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"
#include "base/profile.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "lab/bench/bench_plan.hpp"
#include "lab/bench/schedule.hpp"
#include "output/metrics/metrics.hpp"

namespace hypotrack::bench {
inline namespace HYPOTRACK_EXPORTED internal {

enum class Outcome {
  measured,
  unavailable,  ///< this machine, build or scene does not support this configuration
  failed,       ///< it failed while tracking
};
std::string_view to_string(Outcome outcome);

/// Time, memory and accuracy of tracking a case in one configuration.
struct Measurement {
  Outcome outcome = Outcome::measured;
  std::string message = {};  ///< reason if there are no numbers
  std::string device = {};   ///< SceneTracker::backend()
  int warm_up = 0;
  std::vector<double> seconds = {};      ///< of every measured frame, from the frame to the result
  std::vector<double> evaluations = {};  ///< of every measured frame
  Metrics metrics = {};                  ///< of the measured frames
  /// GPU memory in use since before the scene was opened, by any process; nothing without a GPU.
  std::optional<double> device_mib = {};
  std::vector<Profile::Part> parts = {};  ///< of the measured frames together, if profiled
};

/// Tracks frames in memory, one after the other. The first must have views. Moves their images to
/// where a source would allocate them for this configuration. Calls `again` before every frame; it
/// ends the work by returning false. A profile waits for the GPU after every part. Reports errors
/// in the result and does not throw.
Measurement measure(const Case& c, const Configuration& configuration, std::vector<Frame>& frames,
                    PluginLoader& plugins, const Limits& limits, bool profiles,
                    const std::function<bool()>& again);

}  // namespace internal
}  // namespace hypotrack::bench
