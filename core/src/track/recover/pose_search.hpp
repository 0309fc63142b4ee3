#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "tile/tiles.hpp"
#include "track/recover/held_models.hpp"
#include "track/recover/least_squares.hpp"
#include "track/recover/place_finder.hpp"
#include "track/recover/postures.hpp"
#include "track/recover/recovery_settings.hpp"
#include "track/search/frame_search.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A guess of a model's pose, and the distribution of hypotheses around it.
struct PoseGuess {
  Eigen::Vector3d center;  ///< of the model's landmarks, in the world, metres
  Eigen::VectorXd pose;    ///< the model's parameters
  double near_share = 0;   ///< share of the hypotheses near its rotation
  double rotation = 0;     ///< standard deviation of their rotations, radians
  /// Standard deviation of the hypotheses' centres, metres; twice that in depth.
  double scatter = 0.012;
  double covered = 0.5;  ///< largest share of the model that others may hide
  bool centred = false;  ///< looks at a tile around `center`, not around the first hypothesis
};

/// Numbers of hypotheses that a search of one place scores and refines.
struct HypothesisCounts {
  int hypotheses = 0;  ///< number scored
  int refined = 0;     ///< number of the best refined by least squares
  int kept = 0;        ///< most poses to refine in the fine tile, too
};

/// Result of a search of one place.
struct FoundPoses {
  std::vector<Refined> poses;
  std::int64_t evaluations = 0;
};

/// Sorts poses by their costs. Leaves the first ones that are `near` metres or more apart (mean
/// over landmarks), at most `count`.
void leave_distinct(const Scene& scene, double near, std::size_t count,
                    std::vector<Refined>& poses);

/// Searches all rotations and postures of one model of a scene at given places. Scores hypotheses
/// in a coarse tile and refines the best by least squares, ever fewer of them: first there, then in
/// a tile of twice the size.
class PoseSearch {
 public:
  /// The scene must outlive the search.
  PoseSearch(const Scene& scene, std::size_t model, const std::vector<Camera>& cameras,
             const RecoverySettings& settings);

  /// Finds different poses of the model in a frame around a place, cheapest first. Their costs are
  /// comparable with each other only. `base` is the scene's state. Models with `hidden` are not
  /// drawn, except those held; the others keep their poses.
  FoundPoses find(FrameSearch& search, const Frame& frame, const Eigen::VectorXd& base,
                  const std::vector<bool>& hidden, const std::vector<HeldModel>& held,
                  const PoseGuess& guess, const HypothesisCounts& counts, std::uint64_t seed);

  /// Tries each limb straight, half bent and bent in the prepared frame; `moving` flags the models
  /// that least squares moves. Returns nothing if that hardly lowers the cost of the state. Adds to
  /// `evaluations`.
  std::optional<Eigen::VectorXd> with_better_limbs(Cost& cost, const Eigen::VectorXd& state,
                                                   const std::vector<bool>& moving,
                                                   std::int64_t& evaluations) const;

  /// Returns the state with the hidden models and the sought one moved behind the camera, where
  /// nothing draws them.
  Eigen::VectorXd without(const Eigen::VectorXd& base, const std::vector<bool>& hidden) const;

  Postures& postures() { return postures_; }
  /// Returns the centre of the model's landmarks in a state of the scene.
  Eigen::Vector3d center(const Eigen::VectorXd& state) const;
  /// Returns the root mean square distance of the rest pose's vertices from their mean, in metres.
  double radius() const { return radius_; }

 private:
  /// Tries each limb of some poses straight, half bent and bent. Keeps a change if its refined cost
  /// is lower.
  void improve_limbs(LeastSquares& least_squares, Cost& cost, std::span<Refined> poses) const;
  Eigen::MatrixXd hypotheses(const PoseGuess& guess, int count, std::mt19937_64& random) const;
  /// Prepares the frame in a tile around one pose of the model.
  void take_in(FrameSearch& search, const TileMaker& tiles, const Frame& frame,
               const Eigen::VectorXd& base, const Eigen::VectorXd& hypothesis) const;
  /// Refines poses in the coarse tile and keeps the ones of lowest cost, `kept` or more.
  void refine_coarsely(LeastSquares& least_squares, Cost& cost, std::size_t kept,
                       std::vector<Refined>& poses) const;

  const Scene& scene_;
  const Scene::Item& item_;
  std::size_t model_;
  Scene single_;
  TileMaker coarse_, fine_;
  Postures postures_;
  Eigen::Vector3d behind_;  ///< a point behind the first camera, which is not drawn
  double radius_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
