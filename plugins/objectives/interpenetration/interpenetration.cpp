#include "interpenetration.hpp"

#include <vector>

#include "collision_term.hpp"

namespace hypotrack::interpenetration {
namespace {

/// Returns scratch memory of the calling thread, so that a hypothesis costs no allocation.
float* scratch_of(const CollisionTerm& term) {
  thread_local std::vector<double> scratch;  // doubles, as the memory holds pointers
  const auto doubles = (static_cast<std::size_t>(term.scratch_floats()) + 1) / 2;
  if (scratch.size() < doubles) scratch.resize(doubles);
  return reinterpret_cast<float*>(scratch.data());
}

}  // namespace

Interpenetration::Interpenetration(const InterpenetrationParams& params, const Scene& scene,
                                   const std::string& where)
    : plan_(scene, params.tolerance, params.within_models, where), term_(plan_.term()) {}

double Interpenetration::do_cost(const RenderedHypothesis& hypothesis) const {
  return term_.cost(hypothesis.state.data(), static_cast<int>(hypothesis.state.size()), OneThread{},
                    scratch_of(term_));
}

void Interpenetration::do_write_residuals(const RenderedHypothesis& hypothesis,
                                          std::span<float> residuals) const {
  do_cost_and_residuals(hypothesis, residuals);
}

double Interpenetration::do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                               std::span<float> residuals) const {
  const auto put = [&](std::int64_t i, float r) { residuals[static_cast<std::size_t>(i)] = r; };
  return term_.cost_and_residuals(hypothesis.state.data(),
                                  static_cast<int>(hypothesis.state.size()), OneThread{},
                                  scratch_of(term_), put);
}

std::unique_ptr<cuda::DeviceObjective> Interpenetration::do_on_device() const {
  return interpenetration::on_device(term_);
}

}  // namespace hypotrack::interpenetration
