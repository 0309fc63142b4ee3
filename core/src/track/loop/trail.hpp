#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/solution.hpp"
#include "tile/tiles.hpp"
#include "track/one_euro.hpp"
#include "track/prediction.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The state that the next search begins at, and the states before: their motion predicts, and
/// smooths what is returned.
class Trail {
 public:
  /// The scene must outlive the trail.
  Trail(const Scene& scene, const PredictionSettings& prediction, const OneEuroSettings& smoothing,
        Eigen::VectorXd start);

  const Eigen::VectorXd& state() const { return state_; }
  /// Returns whether a solution was added; otherwise state() is the start.
  bool has_solution() const { return time_.has_value(); }
  /// Returns the seconds since the last solution. Precondition: has_solution().
  double seconds_until(double time) const { return time - *time_; }

  /// Returns states (DxN) that a search at a time may begin at, the middle one, which is in view,
  /// first. With more than `most` of them, it is the only one.
  Eigen::MatrixXd predicted(double time, const TileMaker& tiles, std::int64_t most) const;
  /// Returns the last motion per second, a difference of tangent.hpp; empty: unknown.
  Eigen::VectorXd velocity() const;

  /// Begins the next search at a state that is no solution.
  void move_to(Eigen::VectorXd state) { state_ = std::move(state); }
  /// Adds a solution.
  void add(Eigen::VectorXd state, double time);
  /// Forgets the motion: the last solution does not continue those before.
  void interrupt();
  /// Forgets the motion, and the solution that it led to.
  void begin_anew();
  /// Begins at the given start again.
  void return_to_start() { time_.reset(); }

  /// Returns the state of a frame for the user, smoothed if the settings say so.
  Eigen::VectorXd output(const Solution& solution);

 private:
  Eigen::VectorXd state_;
  std::optional<double> time_;  ///< of the last solution
  Predictor predictor_;
  std::optional<OneEuroFilter> smoother_;
  Eigen::VectorXd output_;  ///< the last one
};

}  // namespace internal
}  // namespace hypotrack
