#pragma once

#include <optional>
#include <vector>

#include "calibrate/pair_collector.hpp"
#include "hypotrack/plugin/source.hpp"
#include "interrupt.hpp"
#include "live_pairs/pair_folder.hpp"

namespace hypotrack::app {

/// Pairs that were taken, and whether Ctrl-C ended it.
struct TakenPairs {
  std::vector<calibrate::BoardPair> pairs;
  cv::Size picture;
  bool interrupted = false;
};

/// Takes pairs of a board before live cameras into a folder, and says what is seen and what is
/// wanted. Ends when the pairs suffice, by Enter or Ctrl-C, or after `seconds`. Removes fewer pairs
/// than a calibration needs. Throws DataError if the cameras are gone or, unless interrupted, there
/// are too few pairs.
TakenPairs take_pairs(const calibrate::BoardFinder& finder, Source& source, PairFolder& folder,
                      const std::optional<double>& seconds, const InterruptGuard& interrupt);

}  // namespace hypotrack::app
