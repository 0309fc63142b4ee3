#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/evaluator.hpp"
#include "geometry/tiles.hpp"
#include "hindsight/hindsight_settings.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/optimizer.hpp"
#include "metrics/landmark_errors.hpp"
#include "track/one_euro.hpp"
#include "track/photometric.hpp"
#include "track/prediction.hpp"
#include "track/search_space.hpp"
#include "track/status.hpp"
#include "track/uncertainty.hpp"

namespace hypotrack {

/// The answer for one frame.
struct Solution {
  int frame = 0;
  double time = 0;
  Status status = Status::missing;
  double cost = 0;  ///< NaN if the frame was missing
  std::int64_t evaluations = 0;
  double seconds = 0;     ///< from the frame to the answer: tiles, features and search
  Eigen::VectorXd state;  ///< normalised; smoothed if the tracker was told to
  /// How far off each landmark of the scene may be, in metres: the root of the expected square.
  /// Empty if the tracker was not told to say, NaN if the frame was missing.
  Eigen::VectorXd sigma;
};

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

/// Follows a scene from frame to frame: the search of a frame starts from the last solution, or
/// from where its motion leads.
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

  /// What people should know of a start at which frames like this usable one count as lost or
  /// uncertain; nothing of a good one.
  std::string problem_of_start(const Frame& frame) const;

  /// What the search of `frame`, the last one tracked, saw of it; with the highlights.
  Observation seen(const Frame& frame) const;

  /// What evaluates hypotheses, for the run's protocol.
  std::string backend() const { return evaluator_.backend(); }

 private:
  /// The answer of a search.
  struct Found {
    Eigen::VectorXd state;
    double cost = 0;
    std::int64_t evaluations = 0;
  };
  /// States that the search of a frame may start from, the middle one, which is seen, first.
  Eigen::MatrixXd possible_starts(double time);
  Eigen::VectorXd cheapest(const Eigen::MatrixXd& states);
  void go_on_from(const Eigen::VectorXd& found, const Frame& frame);
  Eigen::VectorXd smoothed(const Solution& solution);
  /// Mean over a model's landmarks, of the model where it is largest; NaN without sigmas.
  double largest_sigma(const Eigen::VectorXd& sigma) const;
  /// Takes the frame in for searches that begin at `start` (Observation::start_is_guess), or near
  /// it.
  void look(const Frame& frame, const Eigen::VectorXd& start, bool is_guess);
  Found search(const Frame& frame);
  /// Searches the frame as it is taken in, and then again as it looks from the answer.
  Found search_twice(const Frame& frame, const Eigen::VectorXd& prior, const Budget& budget,
                     std::uint64_t seed);
  /// Searches the frame as it is taken in.
  Found search_from(const Eigen::VectorXd& prior, const Budget& budget, std::uint64_t seed);

  TrackerParts parts_;
  TileMaker tiles_;
  PhotometricMatch photometric_;
  SearchSpace space_;
  Evaluator evaluator_;
  TilePlan plan_;  ///< of the last frame
  StatusMonitor monitor_;
  LandmarkLayout landmarks_;
  std::optional<PoseUncertainty> uncertainty_;
  Predictor predictor_;
  OneEuroFilter smoother_;
  Eigen::VectorXd state_;   ///< the last solution as it was found
  Eigen::VectorXd output_;  ///< and as it was given out
  bool found_any_ = false;  ///< whether `state_` is a solution
  std::uint64_t seed_;
};

}  // namespace hypotrack
