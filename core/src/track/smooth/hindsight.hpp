#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "cost/evaluator.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "track/smooth/hindsight_settings.hpp"
#include "track/smooth/motion_prior.hpp"
#include "track/smooth/trajectory_fit.hpp"

namespace hypotrack {

/// Changes what was found, frame by frame, by what later frames show. It looks at the frames of a
/// window together (TrajectoryFit), from where they were found; all but those of the last `lag` are
/// then settled, and the two last of these hold on to the next window's.
class HYPOTRACK_API Hindsight {
 public:
  /// The scene must outlive it. Throws ConfigError where a term has no residuals, or the settings
  /// do not fit each other or the scene. With `highlights` these are taken off the tiles.
  Hindsight(const Scene& scene, std::vector<ObjectiveTerm> terms, const EvaluateSettings& evaluate,
            const HindsightSettings& settings, bool highlights = false);

  /// Takes in a frame after those before it: the tiles that its search saw, but with highlights, or
  /// nothing where that tells nothing of the scene, and the state that was found.
  void add(Sight sight, const Moment& found);

  /// A state that is not changed any more.
  struct Settled {
    Eigen::VectorXd state;
    std::int64_t evaluations = 0;  ///< that hindsight has taken for it
  };
  /// Those since the last call, in the order of add().
  std::vector<Settled> take();
  /// The rest, when no more frames come.
  std::vector<Settled> finish();

 private:
  void settle(std::size_t count);

  HindsightSettings settings_;
  Evaluator evaluator_;
  MotionPrior motion_;
  std::optional<TileHighlights> highlights_;
  TrajectoryFit fit_;
  std::vector<Moment> moments_;  ///< the settled two, then those that wait
  std::vector<Sight> sights_;
  std::vector<std::int64_t> evaluations_;
  std::size_t fixed_ = 0;
  std::vector<Settled> settled_;
};

}  // namespace hypotrack
