#include <algorithm>
#include <string>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/optimizer.hpp"

namespace hypotrack {

void Requirements::merge(const Requirements& other) {
  if (other.least_squares) {
    jacobian = least_squares ? std::max(jacobian, other.jacobian) : other.jacobian;
    least_squares = true;
  }
  if (device || !other.device) return;
  device = true;
  device_by = other.device_by;
  instead_of_device = other.instead_of_device;
}

void check_requirements(const Requirements& requirements, const CostOffer& offer) {
  if (requirements.least_squares && !offer.no_least_squares.empty()) {
    throw ConfigError("objective: the optimizer needs residuals: " + offer.no_least_squares);
  }
  if (requirements.least_squares && requirements.jacobian == Linearization::needed &&
      !offer.no_jacobian.empty()) {
    throw ConfigError("the optimizer takes analytic Jacobians: " + offer.no_jacobian);
  }
  if (requirements.device && !offer.device) {
    constexpr const char* kElsewhere =
        "this scene is not evaluated there. Write `evaluate: {backend: cuda}`";
    throw DeviceError(
        (requirements.device_by.empty() ? "the optimizer" : requirements.device_by) +
        " searches on the GPU, and " + (offer.no_device.empty() ? kElsewhere : offer.no_device) +
        (requirements.instead_of_device.empty() ? "" : ", or " + requirements.instead_of_device));
  }
}

void check_requirements(const Requirements& requirements, const ResidualCost* residuals,
                        const cuda::DeviceCost* device) {
  CostOffer offer{.device = device != nullptr};
  if (!residuals) {
    offer.no_least_squares =
        "this cost has none; take an optimizer that needs costs only, such as `optimizer: {type: "
        "pso}`";
  } else if (!residuals->can_linearize()) {
    offer.no_jacobian =
        "no term of this cost that needs rendering has slopes or a Jacobian of its residuals "
        "where it is evaluated. Write "
        "`jacobian: "
        "auto` or `numerical` in the optimizer";
  }
  check_requirements(requirements, offer);
}

}  // namespace hypotrack
