#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Presentation of a metric of a run.
struct MetricInfo {
  std::string key;    ///< as in metrics.json
  std::string label;  ///< `mean error`
  std::string unit;   ///< `mm`, `%`, or empty
  double factor = 1;  ///< from the stored number to the unit
  int digits = 2;     ///< after the decimal point
  enum class Better { lower, higher, neither } better = Better::neither;

  /// Returns the label with the unit: `mean error (mm)`.
  std::string label_with_unit() const;
};

/// Returns how a metric is shown. An unknown metric is shown under its own name.
MetricInfo metric_info(const std::string& key);

/// Returns the metrics of the tables' columns, in their order.
const std::vector<std::string>& table_metrics();

}  // namespace internal
}  // namespace hypotrack
