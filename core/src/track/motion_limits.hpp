#pragma once

#include <Eigen/Core>

#include "hypotrack/export.hpp"
#include "hypotrack/params.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// How far a scene may be from where it was: no answer is farther.
struct Reach {
  double position = 0;  ///< metres, of each model's origin
  double rotation = 0;  ///< radians, of each model
  double angle = 0;     ///< radians, of each joint angle
};

/// `tracker.motion:` of a scene. The defaults are above what people's hands do.
struct MotionLimits {
  double speed = 4;
  double turn = 2000 * kDegree;
  double bend = 2500 * kDegree;
  void visit(ParamVisitor& v) {
    v("speed_m_s", speed, {.help = "fastest motion of a model", .min = 1e-3, .max = 1e6});
    v("turn_deg_s", turn,
      {.help = "fastest rotation of a model", .min = 1e-3, .max = 1e9, .to_si = kDegree});
    v("bend_deg_s", bend,
      {.help = "fastest change of a joint angle", .min = 1e-3, .max = 1e9, .to_si = kDegree});
  }
};

/// How far a scene can get within a time.
HYPOTRACK_API Reach reach_within(const MotionLimits& limits, double seconds);

/// Whether a normalised state is within reach of another.
HYPOTRACK_API bool is_within(const Scene& scene, const Reach& reach, const Eigen::VectorXd& from,
                             const Eigen::VectorXd& to);

}  // namespace hypotrack
