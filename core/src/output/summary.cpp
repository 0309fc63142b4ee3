#include "output/summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace hypotrack {

std::string to_json(const Summary& s) {
  nlohmann::ordered_json json;
  json["complete"] = s.complete;
  json["frames"] = s.metrics.frames;
  json["fps"] = s.fps;
  json["evaluations_per_second"] = s.evaluations_per_second;
  json["lost_frames"] = s.metrics.lost_frames;
  json["uncertain_frames"] = s.uncertain_frames;
  json["missing_frames"] = s.metrics.missing_frames;
  json["backend"] = s.backend;
  if (s.metrics.evaluated_frames > 0) {
    json["mean_joint_error_mm"] = s.metrics.mean_error_mm;
    json["median_joint_error_mm"] = s.metrics.median_error_mm;
    for (const std::size_t mm : {5, 10, 20, 40})
      json[fmt::format("fraction_below_{}mm", mm)] = s.metrics.success_curve[mm];
  }
  if (s.mean_sigma) json["mean_sigma_mm"] = 1000 * *s.mean_sigma;
  if (s.reliability.count() > 0) {
    json["error_over_sigma"] = s.reliability.error_over_sigma();
    for (const int sigmas : {1, 2, 3})
      json[fmt::format("within_{}_sigma", sigmas)] = s.reliability.within(sigmas);
  }
  return json.dump(2) + "\n";
}

}  // namespace hypotrack
