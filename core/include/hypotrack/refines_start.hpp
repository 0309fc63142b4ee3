#pragma once

#include <Eigen/Core>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// An objective that finds a better start of the search while it prepares a frame also derives from
/// this class. It may look for it with less than drawing hypotheses takes.
class HYPOTRACK_API RefinesStart {
 public:
  RefinesStart() = default;
  virtual ~RefinesStart();
  RefinesStart(const RefinesStart&) = delete;
  RefinesStart& operator=(const RefinesStart&) = delete;

  /// Returns the state from which to search the prepared frame first, in place of
  /// Observation::start. Only the models that the objective knows differ from it. Empty: no better
  /// one is known.
  virtual Eigen::VectorXd refined_start() const = 0;
};

}  // namespace hypotrack
