#include "track/tracker_parts.hpp"

#include <algorithm>

namespace hypotrack::internal {

Requirements requirements_of(const TrackerParts& parts) {
  Requirements all = parts.optimizer->requirements();
  if (parts.status.uncertainty.enabled) all.merge({.least_squares = true});
  if (parts.fixed_lag.enabled) {
    all.merge({.least_squares = true, .jacobian = Linearization::welcome});
  }
  return all;
}

bool look_at_pictures(const std::vector<ObjectiveTerm>& terms) {
  return std::ranges::any_of(terms, [](const ObjectiveTerm& term) {
    return term.weight != 0 && term.objective->needs_rendering();
  });
}

}  // namespace hypotrack::internal
