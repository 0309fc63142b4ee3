#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/plugin.hpp"
#include "lab/bench/bench_plan.hpp"
#include "lab/bench/schedule.hpp"
#include "output/metrics/metrics.hpp"

namespace hypotrack::bench {

enum class Outcome {
  measured,
  unavailable,  ///< this machine, this build or this scene cannot be tracked in this way
  failed,       ///< it broke while it tracked
};
HYPOTRACK_API std::string_view to_string(Outcome outcome);

/// What tracking a case in one way took.
struct Measurement {
  Outcome outcome = Outcome::measured;
  std::string message = {};  ///< why there are no numbers
  std::string device = {};   ///< Tracker::backend()
  int warm_up = 0;
  std::vector<double> seconds = {};      ///< of every measured frame, from the frame to the answer
  std::vector<double> evaluations = {};  ///< of every measured frame
  Metrics metrics = {};                  ///< of the measured frames
  /// What it took of the GPU's memory, where there is one, whatever uses it.
  std::optional<double> device_mib = {};
};

/// Tracks frames, which lie in memory, one after the other; the first of them has views. Their
/// images move to where a source would make them for this way. `again` is asked before every frame
/// and ends the work by returning false. What goes wrong is told in the result and not thrown.
HYPOTRACK_API Measurement measure(const Case& c, const Way& way, std::vector<Frame>& frames,
                                  PluginLoader& plugins, const Limits& limits,
                                  const std::function<bool()>& again);

}  // namespace hypotrack::bench
