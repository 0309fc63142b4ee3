#include "lab/report/tables/cells.hpp"

#include <cmath>
#include <set>

namespace hypotrack::internal {

std::vector<StudyCell> cells_of(const StudyData& study, const std::string& scene,
                                const std::string& part) {
  std::vector<StudyCell> cells;
  for (const StudyRun& run : study.runs) {
    if (run.scene != scene) continue;
    if (!part.empty() && run.on_axis(study.table_per) != part) continue;
    std::vector<std::string> settings;
    for (const StudyAxis& axis : study.axes) settings.push_back(run.on_axis(axis.key));
    if (cells.empty() || cells.back().settings != settings)
      cells.push_back({.settings = settings, .runs = {}, .failed = 0});
    if (run.failed)
      ++cells.back().failed;
    else
      cells.back().runs.push_back(&run);
  }
  return cells;
}

std::vector<const StudyRun*> distinct_runs(const std::vector<const StudyRun*>& runs) {
  std::vector<const StudyRun*> distinct;
  std::set<std::uint64_t> known;
  for (const StudyRun* run : runs)
    if (!run->result || known.insert(*run->result).second) distinct.push_back(run);
  return distinct;
}

Sample sample_of(const std::vector<const StudyRun*>& runs, const MetricInfo& metric) {
  Sample sample;
  for (const StudyRun* run : distinct_runs(runs)) {
    const double value = metric.factor * run->number(metric.key);
    if (!std::isfinite(value)) continue;
    sample.seeds.push_back(run->seed);
    sample.values.push_back(value);
  }
  return sample;
}

}  // namespace hypotrack::internal
