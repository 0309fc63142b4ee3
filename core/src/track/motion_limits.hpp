#pragma once

#include <Eigen/Core>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/params.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Largest change of a scene's pose that a search allows.
struct Reach {
  double position = 0;  ///< metres, of each model's origin and of each joint that slides
  double rotation = 0;  ///< radians, of each model
  double angle = 0;     ///< radians, of each joint angle
};

/// `status.motion:` of a scene. The defaults exceed the motions of people.
struct MotionLimits {
  double speed = 4;
  double turn = 2000 * kDegree;
  double bend = 2500 * kDegree;
  void visit(ParamVisitor& v) {
    v("speed_m_s", speed,
      {.help = "fastest motion of a model, or of a joint that slides", .min = 1e-3, .max = 1e6});
    v("turn_deg_s", turn,
      {.help = "fastest rotation of a model", .min = 1e-3, .max = 1e9, .to_si = kDegree});
    v("bend_deg_s", bend,
      {.help = "fastest change of a joint angle", .min = 1e-3, .max = 1e9, .to_si = kDegree});
  }
};

/// Returns the largest change of pose within a time. A time that is not positive counts as 1/30 s.
Reach reach_within(const MotionLimits& limits, double seconds);

/// Returns whether a normalised state is within reach of another.
bool is_within(const Scene& scene, const Reach& reach, const Eigen::VectorXd& from,
               const Eigen::VectorXd& to);

}  // namespace internal
}  // namespace hypotrack
