#include "output/run_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "output/overlay_video.hpp"

namespace hypotrack {
namespace {

constexpr double kLostError = 0.040;  // metres

/// Appends numbers with as many digits as repeat them exactly.
void append_numbers(std::string& row, const double* values, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i)
    fmt::format_to(std::back_inserter(row), ",{}", values[i]);
}

}  // namespace

std::string to_json(const Summary& s) {
  nlohmann::ordered_json json;
  json["complete"] = s.complete;
  json["frames"] = s.frames;
  json["fps"] = s.fps;
  json["evaluations_per_second"] = s.evaluations_per_second;
  json["lost_frames"] = s.lost_frames;
  json["uncertain_frames"] = s.uncertain_frames;
  json["missing_frames"] = s.missing_frames;
  json["backend"] = s.backend;
  if (s.errors) {
    json["mean_joint_error_mm"] = s.errors->mean;
    json["median_joint_error_mm"] = s.errors->median;
    for (std::size_t i = 0; i < kErrorThresholdsMm.size(); ++i)
      json[fmt::format("fraction_below_{}mm", kErrorThresholdsMm[i])] = s.errors->fraction_below[i];
  }
  return json.dump(2) + "\n";
}

RunOutput::RunOutput(const Scene& scene, const Camera& camera, Options options)
    : scene_(&scene),
      options_(std::move(options)),
      directory_(options_.directory, {"track.csv", "joints.csv", "errors.csv", "overlay.mp4",
                                      "run.yaml", "summary.json"}),
      track_(directory_.part("track.csv")),
      joints_(directory_.part("joints.csv")) {
  TextFile(directory_.part("run.yaml")).write(options_.resolved);
  if (options_.overlay)
    overlay_ = std::make_unique<OverlayVideo>(directory_.part("overlay.mp4"), scene, camera,
                                              options_.frame_rate);
  write_headers();
}

RunOutput::~RunOutput() = default;

void RunOutput::write_headers() {
  std::string track = "frame,time,status,cost,evaluations,milliseconds";
  for (const Parameter& p : scene_->parameters()) track += "," + p.name;
  track_.write(track + "\n");
  std::string joints = "frame,time";
  for (const std::string& name : scene_->landmark_names())
    for (const char* axis : {"_x", "_y", "_z"}) joints += "," + name + axis;
  joints_.write(joints + "\n");
}

double RunOutput::add(const Frame& frame, const Solution& solution) {
  directory_.keep();
  std::string row = fmt::format("{},{},{},{},{},{:.3f}", solution.frame, solution.time,
                                to_string(solution.status), solution.cost, solution.evaluations,
                                1000 * solution.seconds);
  append_numbers(row, solution.state.data(), solution.state.size());
  track_.write(row + "\n");

  const Eigen::Matrix3Xd landmarks = scene_->landmarks(solution.state);
  row = fmt::format("{},{}", solution.frame, solution.time);
  append_numbers(row, landmarks.data(), landmarks.size());
  joints_.write(row + "\n");

  double error = std::numeric_limits<double>::quiet_NaN();
  if (const auto truth = true_landmarks(*scene_, frame)) {
    error = mean_landmark_error(*scene_, landmarks, *truth);
    if (!errors_) {
      errors_.emplace(directory_.part("errors.csv"));
      errors_->write("frame,time,mean_joint_error_mm\n");
    }
    errors_->write(fmt::format("{},{},{:.4f}\n", solution.frame, solution.time, 1000 * error));
  }
  if (overlay_) overlay_->add(frame, solution);

  frame_errors_.push_back(error);
  ++counts_.frames;
  counts_.lost_frames += solution.status == Status::lost || error > kLostError;
  counts_.uncertain_frames += solution.status == Status::uncertain;
  counts_.missing_frames += solution.status == Status::missing;
  seconds_ += solution.seconds;
  evaluations_ += solution.evaluations;
  return error;
}

Summary RunOutput::summarize(bool complete) const {
  Summary summary = counts_;
  summary.complete = complete;
  summary.backend = options_.backend;
  if (seconds_ > 0) {
    summary.fps = (summary.frames - summary.missing_frames) / seconds_;
    summary.evaluations_per_second = static_cast<double>(evaluations_) / seconds_;
  }
  summary.errors = error_statistics(frame_errors_);
  return summary;
}

Summary RunOutput::finish(bool complete) {
  const Summary summary = summarize(complete);
  if (overlay_) overlay_->close();
  TextFile(directory_.part("summary.json")).write(to_json(summary));
  directory_.finish();
  return summary;
}

}  // namespace hypotrack
