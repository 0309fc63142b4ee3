#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// `output.smoothing:` of a scene.
struct OneEuroSettings {
  bool enabled = false;
  double min_cutoff = 1.5;
  double position_beta = 40;
  double angle_beta = 4;
  double speed_cutoff = 1;
  void visit(ParamVisitor& v) {
    v("enabled", enabled,
      {.help = "smooth the states that are written with a one-euro filter; tracking goes on from "
               "the states as they were found"});
    v("min_cutoff_hz", min_cutoff,
      {.help = "cut-off frequency at rest: the lower, the steadier",
       .min = 1e-3,
       .max = 1e6,
       .unit = "Hz"});
    v("position_beta", position_beta,
      {.help = "what a position's speed adds to it: the higher, the less lag",
       .min = 0,
       .max = 1e6,
       .unit = "Hz per m/s"});
    v("angle_beta", angle_beta,
      {.help = "what a rotation's or a joint angle's speed adds to it",
       .min = 0,
       .max = 1e6,
       .unit = "Hz per rad/s"});
    v("speed_cutoff_hz", speed_cutoff,
      {.help = "cut-off frequency of the speeds", .min = 1e-3, .max = 1e6, .unit = "Hz"});
  }
};

/// Smooths states from frame to frame, more at rest than in motion. It is the filter of Casiez,
/// Roussel and Vogel, "1 Euro Filter" (CHI 2012). A position and a rotation are each filtered as a
/// whole, by the length of their speed, rotations along the shortest turn. Every joint is
/// filtered alone.
class OneEuroFilter {
 public:
  /// The scene must outlive the filter.
  OneEuroFilter(const Scene& scene, const OneEuroSettings& settings);

  /// Returns the smoothed state for a normalised state found at a time (s). A time that is not
  /// later than the last one restarts the filter.
  Eigen::VectorXd filter(const Eigen::VectorXd& state, double time);

  /// Restarts the filter: the next state passes unchanged.
  void begin_anew() { state_.resize(0); }

 private:
  double cutoff(double beta, double speed) const { return settings_.min_cutoff + beta * speed; }

  const Scene* scene_;
  OneEuroSettings settings_;
  Eigen::VectorXd state_;  ///< the last smoothed state; empty: none
  Eigen::VectorXd found_;  ///< the last unsmoothed state
  Eigen::VectorXd speed_;  ///< smoothed speed, per second
  double time_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
