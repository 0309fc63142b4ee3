#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The terms of a scene that a GPU evaluates, and the terms that stay on the CPU.
struct SplitTerms {
  std::vector<ObjectiveTerm> gpu;
  std::vector<ObjectiveTerm> cpu;
  /// Returns the names of the terms on the CPU: `landmarks, prior`.
  std::string cpu_names() const;
};

/// Leaves terms on the CPU that need no rendering and have no part for a GPU. With `residuals`, a
/// part that has none does not count. If no term is drawn on the GPU, all are in `gpu`.
SplitTerms split_terms(const std::vector<ObjectiveTerm>& terms, bool residuals);

/// Adds the costs of a scene's terms: those for the GPU, in `drawn`, and those on the CPU, in
/// `posed`. Residuals are in this order too. `backend`: the description of both.
std::unique_ptr<Cost> make_split_cost(const Scene& scene, const SplitTerms& terms,
                                      std::unique_ptr<Cost> drawn, std::unique_ptr<Cost> posed,
                                      std::string backend);

}  // namespace internal
}  // namespace hypotrack
