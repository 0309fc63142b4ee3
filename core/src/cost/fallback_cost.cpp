#include "cost/fallback_cost.hpp"

#include <fmt/format.h>

#include <utility>

namespace hypotrack::internal {

FallbackCost::FallbackCost(const Scene& scene, std::vector<ObjectiveTerm> terms,
                           const EvaluateSettings& settings, const Requirements& requirements)
    : scene_(scene), terms_(std::move(terms)), settings_(settings), requirements_(requirements) {
  if (settings.on_device_loss == OnDeviceLoss::cpu && requirements.device)
    throw ConfigError(fmt::format(
        "{} searches on the GPU only, so evaluate.on_device_loss cannot be `cpu`; write `stop`, or "
        "{} in its place",
        requirements.device_by, requirements.instead_of_device));
  cost_ = make_cost(scene_, terms_, settings_, requirements_);
}

void FallbackCost::leave_device(const DeviceError& error) {
  if (settings_.on_device_loss == OnDeviceLoss::stop || settings_.backend == Backend::cpu) throw;
  settings_.backend = Backend::cpu;
  cost_ = make_cost(scene_, terms_, settings_, requirements_);
  device_error_ = error.what();
}

}  // namespace hypotrack::internal
