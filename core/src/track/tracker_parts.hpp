#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/plugin/judge.hpp"
#include "hypotrack/plugin/optimizer.hpp"
#include "hypotrack/plugin/search.hpp"
#include "hypotrack/plugin/starter.hpp"
#include "tile/tiles.hpp"
#include "track/color/photometric.hpp"
#include "track/one_euro.hpp"
#include "track/search/search_space.hpp"
#include "track/smooth/fixed_lag_settings.hpp"
#include "track/status.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The components and settings of a tracker.
struct TrackerParts {
  std::vector<Camera> cameras;
  std::unique_ptr<Optimizer> optimizer;
  std::vector<ObjectiveTerm> objective;
  TileSettings tile;
  EvaluateSettings evaluate;
  PhotometricSettings photometric;
  SearchSettings search;
  StatusSettings status;
  std::shared_ptr<const Judge> judge = {};  ///< null: solutions are judged by their costs
  OneEuroSettings one_euro;
  FixedLagSettings fixed_lag;
  Budget budget;                          ///< 0 evaluations: the optimizer's default
  SearchClock clock = SearchClock::wall;  ///< of the budget's seconds
  /// Starters that look for lost models, in this order; empty: the global search alone.
  std::vector<std::unique_ptr<Starter>> starters = {};
  /// True if they also look for models that were never seen: no starter gives a state.
  bool begins_by_looking = false;
};

/// Returns what the search, the uncertainty and fixed-lag smoothing require of the cost.
Requirements requirements_of(const TrackerParts& parts);

/// Returns whether any term with a weight looks at pictures.
bool look_at_pictures(const std::vector<ObjectiveTerm>& terms);

}  // namespace internal
}  // namespace hypotrack
