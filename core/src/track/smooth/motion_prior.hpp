#pragma once

#include <Eigen/Core>
#include <array>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "track/smooth/hindsight_settings.hpp"
#include "track/smooth/sight.hpp"

namespace hypotrack {

/// What a change of speed costs: speeds are taken to walk at random (the white-noise acceleration
/// of Bar-Shalom, Li and Kirubarajan, "Estimation with Applications to Tracking and Navigation",
/// 6.2.2), in the tangent space. With v the difference of neighbours over the time between, the
/// cost of three moments is the sum over its numbers of
///
///   |v after - v before|^2 / (sigma^2 T),
///
/// sigma the settings' change in a second and T half the time from the first to the last. A motion
/// of constant speed costs nothing.
class HYPOTRACK_API MotionPrior {
 public:
  /// The scene must outlive it.
  MotionPrior(const Scene& scene, const HindsightSettings& settings);

  /// Of three moments that follow each other.
  struct Change {
    Eigen::VectorXd residual;      ///< sigma times the root of the cost, per number (D)
    std::array<double, 3> factor;  ///< what each residual grows by per unit of its number there
  };
  /// Moments that are less than a millisecond apart, or in the wrong order, count as a millisecond
  /// apart.
  Change change(const Moment& before, const Moment& here, const Moment& after) const;

  /// 1 / sigma^2 of every number (D).
  const Eigen::VectorXd& weight() const { return weight_; }
  double cost(const Moment& before, const Moment& here, const Moment& after) const;

 private:
  const Scene* scene_;
  Eigen::VectorXd weight_;
};

}  // namespace hypotrack
