#include "track/smooth/motion_prior.hpp"

#include <algorithm>
#include <cmath>

#include "track/tangent.hpp"

namespace hypotrack::internal {
namespace {

double seconds_between(const TimedState& before, const TimedState& after) {
  return std::max(after.time - before.time, 1e-3);
}

}  // namespace

MotionPrior::MotionPrior(const Scene& scene, const FixedLagSettings& settings) : scene_(&scene) {
  const std::vector<TangentPart> parts = tangent_parts(scene);
  weight_.resize(parts.back().first + parts.back().size);
  for (const TangentPart& part : parts) {
    const double sigma = is_in_metres(part.kind)                  ? settings.position_change
                         : part.kind == ParameterKind::quaternion ? settings.rotation_change
                                                                  : settings.angle_change;
    weight_.segment(part.first, part.size).setConstant(1 / (sigma * sigma));
  }
}

MotionPrior::Change MotionPrior::change(const TimedState& before, const TimedState& here,
                                        const TimedState& after) const {
  const double first = seconds_between(before, here), second = seconds_between(here, after);
  const double scale = 1 / std::sqrt((first + second) / 2);
  return {scale * (difference(*scene_, here.state, after.state) / second -
                   difference(*scene_, before.state, here.state) / first),
          {scale / first, -scale / first - scale / second, scale / second}};
}

double MotionPrior::cost(const TimedState& before, const TimedState& here,
                         const TimedState& after) const {
  return weight_.dot(change(before, here, after).residual.cwiseAbs2());
}

}  // namespace hypotrack::internal
