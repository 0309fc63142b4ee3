#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/evaluator.hpp"
#include "geometry/tiles.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/optimizer.hpp"
#include "track/search_space.hpp"
#include "track/status.hpp"
#include "track/visible_share.hpp"

namespace hypotrack {

/// The answer for one frame.
struct Solution {
  int frame = 0;
  double time = 0;
  Status status = Status::missing;
  double cost = 0;  ///< NaN if the frame was missing
  std::int64_t evaluations = 0;
  double seconds = 0;     ///< from the frame to the answer: tiles, features and search
  Eigen::VectorXd state;  ///< normalised
};

/// What a tracker is put together from.
struct TrackerParts {
  std::vector<Camera> cameras;
  std::unique_ptr<Optimizer> optimizer;
  std::vector<ObjectiveTerm> objective;
  TileSettings tile;
  EvaluateSettings evaluate;
  SearchSettings search;
  StatusSettings status;
  Budget budget;  ///< 0 evaluations: the optimizer's default
};

/// Follows a scene from frame to frame: the solution of one frame is where the search of the next
/// starts.
class HYPOTRACK_API Tracker {
 public:
  /// The scene must outlive the tracker. `start` is the state that the first frame's search starts
  /// from. Equal seeds and input give equal solutions.
  Tracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start, std::uint64_t seed);
  ~Tracker();
  Tracker(const Tracker&) = delete;
  Tracker& operator=(const Tracker&) = delete;

  Solution track(const Frame& frame);

  /// Takes the frame in as track() does and does not search. Throws what stands in the way: a start
  /// that the cameras do not see, a frame that an objective cannot work with.
  void check(const Frame& frame);

  /// What evaluates hypotheses, for the run's protocol.
  std::string backend() const { return evaluator_.backend(); }

 private:
  OptimizerResult search(const Frame& frame, const Eigen::VectorXd& prior);

  TrackerParts parts_;
  TileMaker tiles_;
  VisibleShare visible_;
  SearchSpace space_;
  Evaluator evaluator_;
  StatusMonitor monitor_;
  Eigen::VectorXd state_;
  std::uint64_t seed_;
};

}  // namespace hypotrack
