#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "hypotrack/api/tracker.hpp"
#include "session/opened_scene.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {

struct Tracker::Impl {
  /// Takes a scene with all parts but the source. Throws ConfigError or DataError.
  Impl(OpenedScene opened, std::vector<Camera> from);

  /// Makes the tracker that starts from `first`.
  void begin(const Frame& first);
  // Throw DataError.
  void check_order(const Frame& frame) const;
  void check_views(const Frame& frame) const;
  /// Expects later frames than this one from now on.
  void pass(const Frame& frame);

  OpenedScene scene;
  std::vector<Camera> cameras;
  Eigen::VectorXd start;                ///< of the first search; empty: it takes a frame to tell
  bool begun = false;                   ///< whether `scene.parts` were given to a tracker
  std::optional<SceneTracker> tracker;  ///< from the first usable frame on if that gives the start
  std::optional<int> last_index;
  double last_time = -std::numeric_limits<double>::infinity();
};

}  // namespace hypotrack
