#include "plausible_motion.hpp"

#include "hypotrack/observation.hpp"
#include "hypotrack/skeleton_pose.hpp"
#include "on_device.hpp"

namespace hypotrack::plausible_motion {

void PlausibleMotion::prepare(const Observation& observation) {
  term_ = residuals_.of(observation);
}

double PlausibleMotion::cost(const RenderedHypothesis& hypothesis) const {
  return term_.cost(hypothesis.state.data(), static_cast<int>(hypothesis.state.size()), OneThread{},
                    nullptr);
}

void PlausibleMotion::write_residuals(const RenderedHypothesis& hypothesis,
                                      std::span<float> residuals) const {
  cost_and_residuals(hypothesis, residuals);
}

double PlausibleMotion::cost_and_residuals(const RenderedHypothesis& hypothesis,
                                           std::span<float> residuals) const {
  const auto put = [&](std::int64_t i, float r) { residuals[static_cast<std::size_t>(i)] = r; };
  return term_.cost_and_residuals(hypothesis.state.data(),
                                  static_cast<int>(hypothesis.state.size()), OneThread{}, nullptr,
                                  put);
}

std::unique_ptr<cuda::DeviceObjective> PlausibleMotion::on_device() const {
  return plausible_motion::on_device(
      [residuals = residuals_](const Observation& observation) mutable {
        return residuals.of(observation);
      });
}

}  // namespace hypotrack::plausible_motion
