#pragma once

#include <string>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// How a number of a run is shown.
struct MetricInfo {
  std::string key;    ///< as in metrics.json
  std::string label;  ///< `mean error`
  std::string unit;   ///< `mm`, `%`, or empty
  double factor = 1;  ///< from the stored number to the unit
  int digits = 2;     ///< after the point
  enum class Better { lower, higher, neither } better = Better::neither;

  /// `mean error (mm)`
  std::string label_with_unit() const;
};

/// What is known about a metric; one that is not known is shown under its own name.
HYPOTRACK_API MetricInfo metric_info(const std::string& key);

/// The columns of the tables, in their order.
HYPOTRACK_API const std::vector<std::string>& table_metrics();

}  // namespace hypotrack
