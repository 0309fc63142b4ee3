#pragma once

#include <span>

#include "hypotrack/export.hpp"
#include "hypotrack/objective.hpp"

namespace hypotrack {

/// An objective that scores many drawn hypotheses in one call also derives from this class, such as
/// one in another language. The scene is then evaluated on the CPU, which draws a block before each
/// call.
class HYPOTRACK_API BatchObjective {
 public:
  BatchObjective() = default;
  virtual ~BatchObjective();
  BatchObjective(const BatchObjective&) = delete;
  BatchObjective& operator=(const BatchObjective&) = delete;

  /// Returns the most hypotheses of one call; 0: calls Objective::cost() instead. The answer never
  /// changes.
  virtual int most_at_once() const { return 64; }

  /// Computes the costs of drawn hypotheses as Objective::cost() does. Called from one thread at a
  /// time.
  virtual void costs(std::span<const RenderedHypothesis> hypotheses,
                     std::span<double> costs) const = 0;
};

}  // namespace hypotrack
