#include "plausible_motion.hpp"

#include "hypotrack/observation.hpp"
#include "hypotrack/skeleton_pose.hpp"
#include "on_device.hpp"

namespace hypotrack::plausible_motion {

void PlausibleMotion::prepare(const Observation& observation) {
  term_ = residuals_.at(observation.start);
}

double PlausibleMotion::cost(const RenderedHypothesis& hypothesis) const {
  return term_.cost(hypothesis.state.data(), static_cast<int>(hypothesis.state.size()), OneThread{},
                    nullptr);
}

std::unique_ptr<cuda::DeviceObjective> PlausibleMotion::on_device() const {
  return plausible_motion::on_device(
      [residuals = residuals_](const Observation& observation) mutable {
        return residuals.at(observation.start);
      });
}

}  // namespace hypotrack::plausible_motion
