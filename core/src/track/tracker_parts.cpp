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

namespace {

/// Returns whether a term reads pictures. One of the state alone need not override image_use(), so
/// that its default does not count.
bool reads_pictures(const Objective& objective) {
  if (objective.needs_rendering()) return true;
  const ImageUse use = objective.image_use();
  return (use.color || use.depth) && !(use.color && use.mask && use.depth);
}

}  // namespace

bool look_at_pictures(const std::vector<ObjectiveTerm>& terms) {
  return std::ranges::any_of(terms, [](const ObjectiveTerm& term) {
    return term.weight != 0 && reads_pictures(*term.objective);
  });
}

}  // namespace hypotrack::internal
