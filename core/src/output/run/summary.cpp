#include "output/run/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace hypotrack::internal {

double clock_fps(const Summary& s) {
  return s.clock.total > 0 ? s.metrics.frames / s.clock.total : 0;
}

std::string to_json(const Summary& s) {
  nlohmann::ordered_json json;
  json["complete"] = s.complete;
  json["frames"] = s.metrics.frames;
  json["fps"] = s.fps;
  if (s.search_fps) json["search_fps"] = *s.search_fps;
  json["evaluations_per_second"] = s.evaluations_per_second;
  json["clock"] = {{"fps", clock_fps(s)},
                   {"seconds", s.clock.total},
                   {"reading_s", s.clock.reading},
                   {"tracking_s", s.clock.tracking},
                   {"writing_s", s.clock.writing}};
  for (const TermSeconds& term : s.terms)
    json["terms"].push_back(
        {{"term", term.name}, {"prepare_s", term.prepare}, {"cost_s", term.cost}});
  const StatusMetrics& status = s.metrics.status;
  json["lost_frames"] = s.metrics.lost_frames;
  json["tracked_frames"] = status.tracked_frames;
  json["uncertain_frames"] = status.uncertain_frames;
  json["said_lost_frames"] = status.said_lost_frames;
  json["absent_frames"] = status.absent_frames;
  json["missing_frames"] = s.metrics.missing_frames;
  json["faults"] = s.faults;
  json["backend"] = s.backend;
  for (const PluginNote& note : s.notes) {
    nlohmann::ordered_json entry = {{"plugin", note.who},
                                    {"level", note.warning ? "warning" : "note"},
                                    {"text", note.text},
                                    {"count", note.count}};
    if (note.frame) entry["first_frame"] = *note.frame;
    json["notes"].push_back(std::move(entry));
  }
  if (s.metrics.evaluated_frames > 0) {
    json["mean_joint_error_mm"] = s.metrics.mean_error_mm;
    json["median_joint_error_mm"] = s.metrics.median_error_mm;
    for (const std::size_t mm : {5, 10, 20, 40})
      json[fmt::format("fraction_below_{}mm", mm)] = s.metrics.success_curve[mm];
  }
  const auto add_known = [&](const char* key, double value) {
    if (!std::isnan(value)) json[key] = value;
  };
  add_known("false_tracked_share", status.false_tracked_share);
  add_known("right_tracked_share", status.right_tracked_share);
  add_known("absent_tracked_share", status.absent_tracked_share);
  if (status.returns > 0) json["returns"] = status.returns;
  add_known("recovered_2_share", status.recovered_2_share);
  add_known("recovered_10_share", status.recovered_10_share);
  add_known("frames_to_recovery", status.frames_to_recovery);
  add_known("lost_sigma_min_mm", status.lost_sigma_min_mm);
  if (s.mean_sigma) json["mean_sigma_mm"] = 1000 * *s.mean_sigma;
  if (s.reliability.count() > 0) {
    json["error_over_sigma"] = s.reliability.error_over_sigma();
    for (const int sigmas : {1, 2, 3})
      json[fmt::format("within_{}_sigma", sigmas)] = s.reliability.within(sigmas);
  }
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace hypotrack::internal
