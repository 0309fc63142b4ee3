#include "output/run_output.hpp"

#include <fmt/format.h>

#include <utility>

#include "output/frame_statuses.hpp"
#include "output/overlay_video.hpp"
#include "output/table_text.hpp"
#include "output/true_landmarks.hpp"
#include "picture/picture.hpp"

namespace hypotrack {
namespace {

/// Returns a line of track.csv.
std::string row_of(const Solution& solution) {
  std::string row = fmt::format("{},{},{},{},{},{:.3f}", solution.frame, solution.time,
                                to_string(solution.status), solution.cost, solution.evaluations,
                                1000 * solution.seconds);
  for (std::size_t m = 0; m < solution.models.size(); ++m) {
    if (solution.models.size() > 1) row += fmt::format(",{}", to_string(solution.models[m]));
    row += fmt::format(",{:.3f}", solution.probabilities[m]);
  }
  for (const double value : solution.state) row += fmt::format(",{}", value);
  return row + "\n";
}

}  // namespace

RunOutput::RunOutput(const Scene& scene, const Camera& camera, Options options)
    : scene_(&scene),
      camera_(camera),
      options_(std::move(options)),
      directory_(options_.directory,
                 {"run.yaml", "track.csv", "joints.csv", "online.csv", "online_joints.csv",
                  "truth_states.csv", "truth_landmarks.csv", "errors.csv", "uncertainty.csv",
                  "overlay.mp4", "worst_#.jpg", "metrics.json", "summary.json"}),
      track_(directory_.part("track.csv")),
      joints_(directory_.part("joints.csv")),
      metrics_(landmark_layout(scene.landmark_names())),
      truth_(scene, metrics_.layout(), directory_),
      uncertainty_(scene, directory_),
      worst_(options_.worst_frames) {
  TextFile(directory_.part("run.yaml")).write(options_.resolved);
  if (options_.overlay)
    overlay_ = std::make_unique<OverlayVideo>(directory_.part("overlay.mp4"), scene, renderer(),
                                              camera, options_.frame_rate);
  std::string track = "frame,time,status,cost,evaluations,milliseconds";
  if (scene.items().size() == 1)
    track += ",probability";
  else
    for (const Scene::Item& item : scene.items())
      track += fmt::format(",{0}.status,{0}.probability", item.name);
  for (const Parameter& p : scene.parameters()) track += "," + p.name;
  track_.write(track + "\n");
  const std::string landmarks = landmarks_header(scene.landmark_names());
  joints_.write(landmarks);
  if (!options_.fixed_lag) return;
  online_.emplace(directory_.part("online.csv")).write(track + "\n");
  online_joints_.emplace(directory_.part("online_joints.csv")).write(landmarks);
}

RunOutput::~RunOutput() = default;

Renderer& RunOutput::renderer() {
  if (!renderer_) renderer_ = std::make_unique<Renderer>(*scene_);
  return *renderer_;
}

void RunOutput::add_online(const Frame& frame, const Solution& solution) {
  directory_.keep();
  online_->write(row_of(solution));
  online_joints_->write(
      table_line(solution.frame, solution.time, scene_->landmarks(solution.state).reshaped()));
  if (overlay_) overlay_->add(frame, solution);
}

double RunOutput::add(const Frame& frame, const Solution& solution) {
  const auto truth = true_landmarks(*scene_, frame);
  if (truth && options_.worst_frames > 0 && !online_)
    renderer();  // without OpenGL, fail now and not at the end
  directory_.keep();
  track_.write(row_of(solution));

  const Eigen::Matrix3Xd landmarks = scene_->landmarks(solution.state);
  joints_.write(table_line(solution.frame, solution.time, landmarks.reshaped()));
  const std::string_view status = to_string(solution.status);
  const FrameError error =
      metrics_.add(solution.frame, solution.time, statuses_of(*scene_, solution), landmarks,
                   truth.value_or(Eigen::Matrix3Xd()),
                   frame.truth ? frame.truth->absent : std::vector<bool>(), solution.sigma);
  if (truth) {
    truth_.add(frame, *truth, error, status);
    if (!online_)
      remember_if_bad(frame, solution, error.mean, {frame.truth->state, *truth}, landmarks);
  }
  uncertainty_.add(solution, error.landmarks);
  if (overlay_ && !online_) overlay_->add(frame, solution);

  ++frames_;
  seconds_ += solution.seconds;
  if (solution.status != Status::tracked && solution.status != Status::missing) {
    search_seconds_ += solution.seconds;
    ++searched_frames_;
  }
  evaluations_ += solution.evaluations;
  return error.mean;
}

void RunOutput::remember_if_bad(const Frame& frame, const Solution& solution, double error,
                                const ScenePose& truth, const Eigen::Matrix3Xd& landmarks) {
  if (!worst_.wants(solution.frame, error)) return;
  worst_.offer({.frame = solution.frame,
                .error = error,
                .status = std::string(to_string(solution.status)),
                .picture = picture_of(frame.views.front()).clone(),
                .solution = {solution.state, landmarks},
                .truth = truth});
}

Summary RunOutput::summarize(bool complete) const {
  Summary summary;
  summary.complete = complete;
  summary.backend = options_.backend;
  summary.metrics = metrics_.metrics();
  summary.mean_sigma = uncertainty_.mean_sigma();
  summary.reliability = uncertainty_.reliability();
  if (seconds_ > 0) {
    summary.fps = (frames_ - summary.metrics.missing_frames) / seconds_;
    summary.evaluations_per_second = static_cast<double>(evaluations_) / seconds_;
    if (search_seconds_ > 0) summary.search_fps = searched_frames_ / search_seconds_;
  }
  return summary;
}

Summary RunOutput::finish(bool complete) {
  const Summary summary = summarize(complete);
  if (overlay_) overlay_->close();
  if (!worst_.frames().empty()) worst_.write(directory_, renderer(), camera_);
  if (truth_.known()) TextFile(directory_.part("metrics.json")).write(to_json(summary.metrics));
  TextFile(directory_.part("summary.json")).write(to_json(summary));
  directory_.finish();
  return summary;
}

}  // namespace hypotrack
