#pragma once

#include <memory>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/camera.hpp"
#include "hypotrack/optimizer.hpp"
#include "tile/tiles.hpp"
#include "track/color/photometric.hpp"
#include "track/one_euro.hpp"
#include "track/search_space.hpp"
#include "track/smooth/hindsight_settings.hpp"
#include "track/status.hpp"

namespace hypotrack {

/// What a tracker is put together from.
struct TrackerParts {
  std::vector<Camera> cameras;
  std::unique_ptr<Optimizer> optimizer;
  std::vector<ObjectiveTerm> objective;
  TileSettings tile;
  EvaluateSettings evaluate;
  PhotometricSettings photometric;
  SearchSettings search;
  StatusSettings status;
  SmoothingSettings smoothing;
  HindsightSettings hindsight;
  Budget budget;  ///< 0 evaluations: the optimizer's default
};

/// What the search and the sigmas of a tracker, and hindsight, want of residuals.
ResidualUse residual_use(const TrackerParts& parts);

/// Whether any term that counts looks at pictures.
bool look_at_pictures(const std::vector<ObjectiveTerm>& terms);

}  // namespace hypotrack
