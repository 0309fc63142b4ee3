#pragma once

#include <Eigen/Core>
#include <array>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "track/smooth/fixed_lag_settings.hpp"
#include "track/smooth/lag_window.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Prior of constant velocity: velocities do a random walk in the tangent space (the white-noise
/// acceleration of Bar-Shalom, Li and Kirubarajan, "Estimation with Applications to Tracking and
/// Navigation", 6.2.2). With v the difference of neighbours over the time between them, the cost of
/// three states is the sum over dimensions of
///
///   |v after - v before|^2 / (sigma^2 T).
///
/// sigma is the settings' change of velocity in a second. T is half the time from the first to the
/// last state. A motion of constant velocity costs nothing.
class MotionPrior {
 public:
  /// The scene must outlive it.
  MotionPrior(const Scene& scene, const FixedLagSettings& settings);

  /// The change of velocity over three consecutive states.
  struct Change {
    Eigen::VectorXd residual;      ///< sigma times the root of the cost, per dimension (D)
    std::array<double, 3> factor;  ///< derivative of each residual by its dimension at each state
  };
  /// Computes the change of velocity. Times less than a millisecond apart, or in the wrong order,
  /// count as a millisecond apart.
  Change change(const TimedState& before, const TimedState& here, const TimedState& after) const;

  /// Returns 1 / sigma^2 of every dimension (D).
  const Eigen::VectorXd& weight() const { return weight_; }
  double cost(const TimedState& before, const TimedState& here, const TimedState& after) const;

 private:
  const Scene* scene_;
  Eigen::VectorXd weight_;
};

}  // namespace internal
}  // namespace hypotrack
