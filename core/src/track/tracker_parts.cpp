#include "track/tracker_parts.hpp"

#include <algorithm>

namespace hypotrack {

ResidualUse residual_use(const TrackerParts& parts) {
  const bool search = parts.optimizer->needs_residuals();
  const bool fixed_lag = parts.fixed_lag.enabled;
  return {search || fixed_lag || parts.status.uncertainty.enabled,
          std::max(search ? parts.optimizer->linearization() : Linearization::unused,
                   fixed_lag ? Linearization::welcome : Linearization::unused)};
}

bool look_at_pictures(const std::vector<ObjectiveTerm>& terms) {
  return std::ranges::any_of(terms, [](const ObjectiveTerm& term) {
    return term.weight != 0 && term.objective->needs_rendering();
  });
}

}  // namespace hypotrack
