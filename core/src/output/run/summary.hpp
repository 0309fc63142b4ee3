#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "output/metrics/metrics.hpp"
#include "output/metrics/reliability.hpp"
#include "plugin/plugin_notes.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// How long a run took by the clock, and how long its parts worked beside each other, in seconds.
struct ClockTimes {
  double total = 0;     ///< from the first frame to the last one written
  double reading = 0;   ///< the source
  double tracking = 0;  ///< images in, state out
  double writing = 0;   ///< the outputs
};

/// How long a term of the objective worked on the CPU, in all threads together, in seconds.
struct TermSeconds {
  std::string name;  ///< `objective.1 (edges)`
  double prepare = 0;
  double cost = 0;
};

/// Summary of a run: summary.json.
struct Summary {
  bool complete = false;  ///< false if the run was interrupted or ended by an error
  double fps = 0;         ///< frames per second of tracking: images in, state out
  /// Frames per second over the frames that are not tracked, in which lost models are searched.
  /// Nothing if there are none.
  std::optional<double> search_fps;
  double evaluations_per_second = 0;
  ClockTimes clock;
  std::vector<TermSeconds> terms;
  std::string backend;
  Metrics metrics;
  std::map<std::string, int> faults;  ///< number of frames, by what was wrong with them
  std::vector<PluginNote> notes;      ///< what plugins told the user
  std::optional<double> mean_sigma;   ///< metres; nothing if uncertainty is off
  Reliability reliability;
};

/// Returns the frames per second by the clock; 0: unknown.
double clock_fps(const Summary& summary);

/// Returns the text of summary.json. Leaves out error statistics where no frame has an error, and
/// those of sigma where there is none.
std::string to_json(const Summary& summary);

}  // namespace internal
}  // namespace hypotrack
