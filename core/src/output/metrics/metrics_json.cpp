#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "output/metrics/metrics.hpp"

namespace hypotrack::internal {
namespace {

using Json = nlohmann::ordered_json;

Json table(const std::vector<std::pair<std::string, double>>& entries) {
  Json json = Json::object();
  for (const auto& [name, value] : entries) json[name] = value;
  return json;
}

/// Writes the status numbers. Counts are null if no frame has a status.
Json numbers(const StatusMetrics& s) {
  const auto count = [&](int frames) { return s.judged_frames > 0 ? Json(frames) : Json(); };
  Json json;
  json["tracked_frames"] = count(s.tracked_frames);
  json["uncertain_frames"] = count(s.uncertain_frames);
  json["said_lost_frames"] = count(s.said_lost_frames);
  json["absent_frames"] = count(s.absent_frames);
  json["tracked_share"] = s.tracked_share;
  json["uncertain_share"] = s.uncertain_share;
  json["absent_share"] = s.absent_share;
  json["false_tracked_share"] = s.false_tracked_share;
  json["right_tracked_share"] = s.right_tracked_share;
  json["absent_tracked_share"] = s.absent_tracked_share;
  json["returns"] = count(s.returns);
  json["recovered_2_share"] = s.recovered_2_share;
  json["recovered_10_share"] = s.recovered_10_share;
  json["frames_to_recovery"] = s.frames_to_recovery;
  json["lost_sigma_min_mm"] = s.lost_sigma_min_mm;
  return json;
}

Json numbers(const Metrics& m) {
  Json json;
  json["frames"] = m.frames;
  json["evaluated_frames"] = m.evaluated_frames;
  json["missing_frames"] = m.missing_frames;
  json["mean_error_mm"] = m.mean_error_mm;
  json["sd_error_mm"] = m.sd_error_mm;
  json["median_error_mm"] = m.median_error_mm;
  json["p75_error_mm"] = m.p75_error_mm;
  json["p90_error_mm"] = m.p90_error_mm;
  json["p95_error_mm"] = m.p95_error_mm;
  json["max_error_mm"] = m.max_error_mm;
  json["auc_20_50"] = m.auc_20_50;
  for (std::size_t i = 0; i < m.success.size(); ++i)
    json[fmt::format("success_{}mm", kSuccessThresholdsMm[i])] = m.success[i];
  json["lost_frames"] = m.lost_frames;
  json["lost_share"] = m.lost_share;
  json["time_to_loss_s"] = m.time_to_loss_s;
  json["frames_to_loss"] = m.frames_to_loss ? Json(*m.frames_to_loss) : Json();
  json["jitter_mm"] = m.jitter_mm;
  json["found_share"] = m.outcomes.share(FrameOutcome::found);
  json["search_failed_share"] = m.outcomes.share(FrameOutcome::search_failed);
  json["objective_failed_share"] = m.outcomes.share(FrameOutcome::objective_failed);
  json.update(numbers(m.status));
  return json;
}

}  // namespace

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  const Json all = numbers(Metrics());
  for (const auto& [name, value] : all.items()) names.push_back(name);
  return names;
}

std::string to_json(const Metrics& m) {
  Json json = numbers(m);
  json["models"] = table(m.models);
  json["landmarks"] = table(m.landmarks);
  std::array<int, kSuccessCurvePoints> thresholds{};
  std::iota(thresholds.begin(), thresholds.end(), 0);
  json["success_curve"] = {{"threshold_mm", thresholds}, {"share", m.success_curve}};
  return json.dump(2) + "\n";  // nlohmann writes NaN as null
}

}  // namespace hypotrack::internal
