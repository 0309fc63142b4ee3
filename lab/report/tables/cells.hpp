#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"
#include "lab/report/statistics/comparison.hpp"
#include "lab/report/statistics/metric_info.hpp"
#include "lab/report/study_data.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The runs of a scene that differ in their seed only.
struct StudyCell {
  std::vector<std::string> settings;  ///< one per axis
  std::vector<const StudyRun*> runs;  ///< finished
  int failed = 0;
};

/// Returns the cells of a scene in the order of the runs. With `part`, only those with this value
/// of the axis that has a table for each value.
std::vector<StudyCell> cells_of(const StudyData& study, const std::string& scene,
                                const std::string& part = {});

/// Returns the runs whose results differ from every earlier run's by at least a bit.
std::vector<const StudyRun*> distinct_runs(const std::vector<const StudyRun*>& runs);

/// Returns a metric of the distinct runs that have it, in the unit of tables.
Sample sample_of(const std::vector<const StudyRun*>& runs, const MetricInfo& metric);

}  // namespace internal
}  // namespace hypotrack
