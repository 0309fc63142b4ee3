#include "interpenetration.hpp"

#include <vector>

#include "on_device.hpp"

namespace hypotrack::interpenetration {
namespace {

/// Memory of the calling thread, so that a hypothesis costs no allocation.
float* scratch_of(const CollisionTerm& term) {
  thread_local std::vector<double> scratch;  // aligned for what holds pointers
  const auto doubles = (static_cast<std::size_t>(term.scratch_floats()) + 1) / 2;
  if (scratch.size() < doubles) scratch.resize(doubles);
  return reinterpret_cast<float*>(scratch.data());
}

}  // namespace

Interpenetration::Interpenetration(const InterpenetrationParams& params, const Scene& scene,
                                   const std::string& where)
    : plan_(scene, params.tolerance, params.within_models, where), term_(plan_.term()) {}

double Interpenetration::cost(const RenderedHypothesis& hypothesis) const {
  return term_.cost(hypothesis.state.data(), static_cast<int>(hypothesis.state.size()), OneThread{},
                    scratch_of(term_));
}

void Interpenetration::write_residuals(const RenderedHypothesis& hypothesis,
                                       std::span<float> residuals) const {
  const PosedShape* in_world = term_.pose(hypothesis.state.data(), OneThread{}, scratch_of(term_));
  for (std::size_t i = 0; i < plan_.pairs.size(); ++i) {
    residuals[i] = term_.excess(in_world, plan_.pairs[i]);
  }
}

std::unique_ptr<cuda::DeviceObjective> Interpenetration::on_device() const {
  return interpenetration::on_device(term_);
}

}  // namespace hypotrack::interpenetration
