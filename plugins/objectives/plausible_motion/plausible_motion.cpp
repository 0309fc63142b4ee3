#include "plausible_motion.hpp"

#include "hypotrack/gpu/skeleton.hpp"
#include "hypotrack/plugin/observation.hpp"
#include "motion_term.hpp"

namespace hypotrack::plausible_motion {

void PlausibleMotion::do_prepare(const Observation& observation) {
  term_ = residuals_.of(observation);
}

double PlausibleMotion::do_cost(const RenderedHypothesis& hypothesis) const {
  return term_.cost(hypothesis.state.data(), static_cast<int>(hypothesis.state.size()), OneThread{},
                    nullptr);
}

void PlausibleMotion::do_write_residuals(const RenderedHypothesis& hypothesis,
                                         std::span<float> residuals) const {
  do_cost_and_residuals(hypothesis, residuals);
}

double PlausibleMotion::do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                              std::span<float> residuals) const {
  const auto put = [&](std::int64_t i, float r) { residuals[static_cast<std::size_t>(i)] = r; };
  return term_.cost_and_residuals(hypothesis.state.data(),
                                  static_cast<int>(hypothesis.state.size()), OneThread{}, nullptr,
                                  put);
}

void PlausibleMotion::do_write_jacobian(const RenderedHypothesis& hypothesis,
                                        std::span<float> residuals, Jacobian& jacobian) const {
  do_cost_and_residuals(hypothesis, residuals);
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
    const LinearResidual& r = term_.residuals[i];
    for (int k = 0; k < 2; ++k) jacobian(i, r.index[k]) += static_cast<float>(r.factor[k]);
  }
}

std::unique_ptr<cuda::DeviceObjective> PlausibleMotion::do_on_device() const {
  return plausible_motion::on_device(
      [residuals = residuals_](const Observation& observation) mutable {
        return residuals.of(observation);
      });
}

}  // namespace hypotrack::plausible_motion
