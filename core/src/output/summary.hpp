#pragma once

#include <optional>
#include <string>

#include "hypotrack/export.hpp"
#include "output/metrics/metrics.hpp"
#include "output/metrics/reliability.hpp"

namespace hypotrack {

/// What a run amounts to; summary.json.
struct Summary {
  bool complete = false;  ///< false if the run was interrupted or ended by an error
  double fps = 0;         ///< frames per second of tracking: images in, state out
  /// The same of the frames that are not tracked: lost models are searched for in them. Nothing if
  /// there are none.
  std::optional<double> search_fps;
  double evaluations_per_second = 0;
  std::string backend;
  Metrics metrics;
  std::optional<double> mean_sigma;  ///< m; nothing if the tracker was not told to say
  Reliability reliability;
};

/// Error statistics are left out where no frame has an error, those of sigma where there is none.
HYPOTRACK_API std::string to_json(const Summary& summary);

}  // namespace hypotrack
