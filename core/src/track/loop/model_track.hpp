#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "track/loop/phase.hpp"
#include "track/status.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The phase of one model, and all that the tracker remembers of the model from frame to frame.
class ModelTrack {
 public:
  /// `first_landmark` is the number of the model's first one in the scene. `start` is a state of
  /// the scene; `is_given`: the model is expected there. The scene must outlive the track.
  ModelTrack(const Scene& scene, std::size_t model, Eigen::Index first_landmark,
             const Eigen::VectorXd& start, bool is_given, const StatusSettings& settings);

  Phase phase() const { return phase_; }

  /// Sets whether the pose rests until the next judge(): no better one is searched.
  void rest(bool rests) { rests_ = rests; }
  /// Returns whether the pose rests and was confirmed in the frame before.
  bool keeps_confirmed() const { return rests_ && confirmed_; }
  /// Returns whether the pose rests and a detector had seen the model near it by the frame before.
  bool keeps_detected() const { return rests_ && detected_; }
  /// Judges the pose of a frame. Returns the model's status.
  Status judge(const StatusMeasures& measures);
  /// Returns the probability that a pose needs to count as right now.
  double needed() const { return monitor_.needed(); }
  /// Returns the threshold above which a cost is unusual (StatusMonitor::usual_cost()).
  double usual_cost() const { return monitor_.usual_cost(); }

  /// Takes the result of a frame. If `is_right`, keeps the pose of the scene's state. `velocity` is
  /// the scene's, a difference of tangent.hpp per second; empty: unknown.
  void take(bool is_right, const Eigen::VectorXd& state, const Eigen::VectorXd& velocity,
            double time);
  /// Knows the model's looks from now on.
  void learn() { move(PhaseEvent::learned); }
  /// Expects the model at the given start no longer.
  void leave_start();
  /// Drops what was learned: it was of something else.
  void forget();
  /// Begins a search anew.
  void restart();

  /// Writes the last right pose, extrapolated by its fading motion, into a state of the scene.
  void extrapolate(double time, Eigen::VectorXd& state) const;
  /// Writes the last right pose into a state of the scene.
  void write_kept(Eigen::VectorXd& state) const;
  /// Returns the seconds since the pose was right; infinite if nothing tells where the model is.
  double seconds_since_right(double time) const;

  /// Takes that a detector sees the model at its pose.
  void see(double time) { seen_time_ = time; }
  /// Returns the seconds since then; infinite: never.
  double seconds_unseen(double time) const { return time - seen_time_; }
  /// Takes a detector's check; `is_elsewhere`: it sees the model, but not at its pose. Returns
  /// whether several in a row contradict the pose.
  bool take_check(bool is_elsewhere);

  /// Returns whether other poses are searched although the pose looks right, as after a loss.
  bool needs_confirmation() const { return confirmations_ > 0; }
  /// Counts a frame of a search for the model. Returns whether it is the first one, the 4th, 16th,
  /// 64th, ...: whole pictures are searched then, even if a detector would see the model
  /// (`is_detectable`). The 4th is not while such a model is unknown.
  bool is_time_to_search_all(bool is_detectable);

  /// Returns the mean sigma of the model's landmarks; NaN without any.
  double mean_sigma(const Eigen::VectorXd& of_scene) const;
  /// Raises the sigmas of a model without a pose to the distance that it may have moved since.
  void widen(double time, Eigen::VectorXd& of_scene) const;
  /// Raises the sigmas of hidden landmarks to the distance that they may have moved since they were
  /// seen. `hidden` flags the scene's landmarks; empty: none. Returns whether the sum of these
  /// sigmas exceeds `most` for every landmark of the model.
  bool widen_hidden(const std::vector<bool>& hidden, bool is_right, double time, double most,
                    Eigen::VectorXd& of_scene);

 private:
  void move(PhaseEvent event) { phase_ = next(phase_, event); }

  const Scene& scene_;
  std::size_t model_;
  Eigen::Index first_landmark_, landmarks_;
  StatusMonitor monitor_;
  Phase phase_;
  Eigen::VectorXd kept_;         ///< parameters of the last right pose; at first, of the start
  double kept_time_ = 0;         ///< of that pose
  Eigen::VectorXd velocity_;     ///< at that time, per second; empty: unknown
  Eigen::VectorXd shown_times_;  ///< at which each landmark was right and not hidden
  double seen_time_ = -std::numeric_limits<double>::infinity();  ///< of see()
  bool rests_ = false;                                           ///< in this frame
  bool confirmed_ = false, detected_ = false;  ///< StatusMeasures of the last frame
  int confirmations_ = 0;                      ///< frames left in which other poses are searched
  unsigned searches_ = 0;   ///< frames in which it was looked for since its pose was right
  int contradictions_ = 0;  ///< checks in a row that contradict the pose
};

}  // namespace internal
}  // namespace hypotrack
