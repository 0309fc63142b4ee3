#include "lab/report/statistics/metric_info.hpp"

#include <algorithm>

namespace hypotrack::internal {
namespace {

using Better = MetricInfo::Better;

const std::vector<MetricInfo>& known_metrics() {
  static const std::vector<MetricInfo> known{
      {"mean_error_mm", "mean error", "mm", 1, 2, Better::lower},
      {"sd_error_mm", "sd of the error", "mm", 1, 2, Better::lower},
      {"median_error_mm", "median error", "mm", 1, 2, Better::lower},
      {"p75_error_mm", "75th percentile", "mm", 1, 2, Better::lower},
      {"p90_error_mm", "90th percentile", "mm", 1, 2, Better::lower},
      {"p95_error_mm", "95th percentile", "mm", 1, 2, Better::lower},
      {"max_error_mm", "largest error", "mm", 1, 1, Better::lower},
      {"auc_20_50", "AUC 20–50 mm", "", 1, 3, Better::higher},
      {"success_5mm", "below 5 mm", "%", 100, 1, Better::higher},
      {"success_10mm", "below 10 mm", "%", 100, 1, Better::higher},
      {"success_20mm", "below 20 mm", "%", 100, 1, Better::higher},
      {"success_30mm", "below 30 mm", "%", 100, 1, Better::higher},
      {"success_40mm", "below 40 mm", "%", 100, 1, Better::higher},
      {"success_50mm", "below 50 mm", "%", 100, 1, Better::higher},
      {"frames", "frames", "", 1, 0, Better::neither},
      {"missing_frames", "frames missing", "", 1, 1, Better::neither},
      {"tracked_frames", "frames tracked", "", 1, 1, Better::neither},
      {"uncertain_frames", "frames uncertain", "", 1, 1, Better::neither},
      {"said_lost_frames", "frames said lost", "", 1, 1, Better::neither},
      {"absent_frames", "frames said absent", "", 1, 1, Better::neither},
      {"tracked_share", "tracked", "%", 100, 1, Better::neither},
      {"uncertain_share", "uncertain", "%", 100, 1, Better::neither},
      {"absent_share", "absent", "%", 100, 1, Better::neither},
      {"false_tracked_share", "tracked but wrong", "%", 100, 2, Better::lower},
      {"right_tracked_share", "right and tracked", "%", 100, 1, Better::higher},
      {"absent_tracked_share", "absent but tracked", "%", 100, 2, Better::lower},
      {"returns", "returns", "", 1, 0, Better::neither},
      {"recovered_2_share", "back in 2 frames", "%", 100, 1, Better::higher},
      {"recovered_10_share", "back in 10 frames", "%", 100, 1, Better::higher},
      {"frames_to_recovery", "frames until back", "", 1, 1, Better::lower},
      {"lost_sigma_min_mm", "least sigma of lost frames", "mm", 1, 1, Better::higher},
      {"lost_frames", "lost frames", "", 1, 1, Better::lower},
      {"lost_share", "frames lost", "%", 100, 1, Better::lower},
      {"time_to_loss_s", "time to loss", "s", 1, 2, Better::neither},
      {"frames_to_loss", "frames to loss", "", 1, 0, Better::neither},
      {"jitter_mm", "jitter", "mm", 1, 2, Better::lower},
      {"found_share", "found", "%", 100, 1, Better::higher},
      {"search_failed_share", "search failed", "%", 100, 1, Better::lower},
      {"objective_failed_share", "objective failed", "%", 100, 1, Better::lower},
      {"evaluations_per_frame", "evaluations per frame", "", 1, 0, Better::neither},
      {"fps", "speed", "frames/s", 1, 1, Better::neither},
      {"frame_seconds", "time of a frame", "s", 1, 2, Better::neither},
      {"search_fps", "speed while not tracked", "frames/s", 1, 1, Better::neither},
      {"evaluations_per_second", "evaluations per second", "", 1, 0, Better::neither}};
  return known;
}

}  // namespace

std::string MetricInfo::label_with_unit() const {
  return unit.empty() ? label : label + " (" + unit + ")";
}

MetricInfo metric_info(const std::string& key) {
  for (const MetricInfo& metric : known_metrics())
    if (metric.key == key) return metric;
  MetricInfo unknown{.key = key, .label = key, .unit = {}};
  std::replace(unknown.label.begin(), unknown.label.end(), '_', ' ');
  return unknown;
}

const std::vector<std::string>& table_metrics() {
  // No best value is marked for two of these. The time to loss ignores runs that were never lost.
  // Speed depends on the machine as much as on the method.
  static const std::vector<std::string> columns{"mean_error_mm",
                                                "lost_share",
                                                "lost_frames",
                                                "evaluations_per_frame",
                                                "fps",
                                                "median_error_mm",
                                                "p95_error_mm",
                                                "success_20mm",
                                                "found_share",
                                                "search_failed_share",
                                                "objective_failed_share",
                                                "tracked_share",
                                                "uncertain_share",
                                                "absent_share",
                                                "false_tracked_share",
                                                "right_tracked_share",
                                                "absent_tracked_share",
                                                "recovered_2_share",
                                                "recovered_10_share",
                                                "auc_20_50",
                                                "time_to_loss_s",
                                                "jitter_mm",
                                                "frame_seconds"};
  return columns;
}

}  // namespace hypotrack::internal
