#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "tile/tiles.hpp"
#include "track/frame_search.hpp"
#include "track/recover/held.hpp"
#include "track/recover/least_squares.hpp"
#include "track/recover/place_finder.hpp"
#include "track/recover/postures.hpp"
#include "track/recover/recovery_settings.hpp"

namespace hypotrack {

/// Where one model may be, and how many hypotheses lie around a pose of it.
struct PoseGuess {
  Eigen::Vector3d center;  ///< of its landmarks, in the world, metres
  Eigen::VectorXd pose;    ///< the model's parameters
  double near_share = 0;   ///< of the hypotheses that keep about its rotation and posture
  double rotation = 0;     ///< standard deviation of those, radians
  /// Standard deviation of the hypotheses' centers, metres; twice in depth.
  double scatter = 0.012;
  /// Points that half of the hypotheses lie about, instead of the center; empty: none do.
  std::vector<Eigen::Vector3d> points = {};
  double covered = 0.5;  ///< share of the model that others may hide
};

/// How much a search spends on one place.
struct PoseEffort {
  int hypotheses = 0;  ///< scored
  int refined = 0;     ///< best of them refined by least squares
  int improved = 0;    ///< best of those refined limb by limb
};

/// Searches all rotations and postures of one model of a scene at given places: scores hypotheses
/// in a coarse tile and refines the best by least squares.
class PoseSearch {
 public:
  /// The scene must outlive it.
  PoseSearch(const Scene& scene, std::size_t model, const std::vector<Camera>& cameras,
             const RecoverySettings& settings);

  /// Finds poses of the model in a frame around a place, best first; costs compare among them only.
  /// `base` is the scene's state; models with `hidden` are not drawn, except those that are held;
  /// the others stay where they are. The first pose bears the evaluations of all.
  std::vector<Refined> find(FrameSearch& search, const Frame& frame, const Eigen::VectorXd& base,
                            const std::vector<bool>& hidden, const std::vector<Held>& held,
                            const PoseGuess& guess, const PoseEffort& effort, std::uint64_t seed);

  /// The state with models that are hidden, and the one that is searched for, where nothing draws
  /// them.
  Eigen::VectorXd without(const Eigen::VectorXd& base, const std::vector<bool>& hidden) const;

  Postures& postures() { return postures_; }
  /// Center of the model's landmarks in a state of the scene.
  Eigen::Vector3d center(const Eigen::VectorXd& state) const;
  /// Root mean square distance of its vertices from their mean, at rest, metres.
  double radius() const { return radius_; }

 private:
  /// Tries each limb straight, half and bent, and keeps what refining makes better.
  void improve_limbs(LeastSquares& least_squares, Evaluator& evaluator, Refined& pose) const;
  Eigen::MatrixXd hypotheses(const PoseGuess& guess, int count, std::mt19937_64& random) const;
  void take_in(FrameSearch& search, const Frame& frame, const Eigen::VectorXd& base,
               const Eigen::VectorXd& hypothesis);

  const Scene& scene_;
  const Scene::Item& item_;
  std::size_t model_;
  Scene single_;
  TileMaker tiles_;
  Postures postures_;
  Eigen::Vector3d behind_;  ///< the first camera: what is there is not drawn
  double radius_ = 0;
};

}  // namespace hypotrack
