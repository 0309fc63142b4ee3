#include "output/run/metrics_output.hpp"

#include <utility>

#include "hypotrack/api/files.hpp"
#include "hypotrack/api/overlay.hpp"
#include "output/evaluate/true_landmarks.hpp"
#include "output/run_directory.hpp"

namespace hypotrack::internal {

FrameStatuses statuses_of(const Scene& scene, const Solution& solution) {
  FrameStatuses out{status_named(to_string(solution.status)).value()};
  for (std::size_t m = 0; m < solution.models.size(); ++m)
    if (!scene.items()[m].model->data().landmarks.empty())
      out.models.push_back(status_named(to_string(solution.models[m])).value());
  return out;
}

std::vector<std::string> MetricsOutput::do_file_names() const {
  return {"truth_states.csv", "truth_landmarks.csv", "errors.csv",   "uncertainty.csv", "trace.csv",
          "truth_costs.csv",  "worst_#.jpg",         "metrics.json", kSummaryFile};
}

void MetricsOutput::do_begin(OutputContext& run) {
  run_ = &run;
  metrics_.emplace(landmark_layout(run.scene().landmark_names()));
  truth_.emplace(metrics_->layout(), run);
  uncertainty_.emplace(run);
  trace_.emplace(run);
}

void MetricsOutput::trace(int frame, const FrameTrace& trace) { trace_->add(frame, trace); }

void MetricsOutput::do_frame(const Frame& frame, const Solution& solution) {
  const Scene& scene = run_->scene();
  const auto truth = true_landmarks(scene, frame);
  const Eigen::Matrix3Xd landmarks = scene.landmarks(solution.state);
  const std::string_view status = to_string(solution.status);
  const FrameError error =
      metrics_->add(solution.frame, solution.time, statuses_of(scene, solution), landmarks,
                    truth.value_or(Eigen::Matrix3Xd()),
                    frame.truth ? frame.truth->absent : std::vector<bool>(), solution.sigma);
  if (truth) {
    truth_->add(frame, *truth, error, status);
    if (frame.truth->state.size() > 0)
      metrics_->add_outcome(trace_->judge(frame.index, 1000 * error.mean));
    if (!run_->fixed_lag())
      remember_if_bad(frame, solution, error.mean, {frame.truth->state, *truth}, landmarks);
  }
  uncertainty_->add(solution, error.landmarks);

  ++frames_;
  if (solution.fault != FrameFault::none) ++faults_[std::string(to_string(solution.fault))];
  seconds_ += solution.seconds;
  if (solution.status != Status::tracked && solution.status != Status::missing) {
    search_seconds_ += solution.seconds;
    ++searched_frames_;
  }
  evaluations_ += solution.evaluations;
}

void MetricsOutput::remember_if_bad(const Frame& frame, const Solution& solution, double error,
                                    const ScenePose& truth, const Eigen::Matrix3Xd& landmarks) {
  if (!worst_.wants(solution.frame, error)) return;
  worst_.offer({.frame = solution.frame,
                .error = error,
                .status = std::string(to_string(solution.status)),
                .picture = picture_of(frame.views.front()).clone(),
                .solution = {solution.state, landmarks},
                .truth = truth});
}

Summary MetricsOutput::summarize(bool complete) const {
  Summary summary;
  summary.complete = complete;
  summary.backend = backend_;
  summary.clock = clock_;
  summary.faults = faults_;
  for (const auto& [name, times] : term_times_) {
    const TermSeconds term{name, times->prepare.seconds(), times->cost.seconds()};
    if (term.prepare + term.cost > 0) summary.terms.push_back(term);  // otherwise on a GPU
  }
  if (notes_) summary.notes = notes_->all();
  summary.metrics = metrics_->metrics();
  summary.mean_sigma = uncertainty_->mean_sigma();
  summary.reliability = uncertainty_->reliability();
  if (seconds_ > 0) {
    summary.fps = (frames_ - summary.metrics.missing_frames) / seconds_;
    summary.evaluations_per_second = static_cast<double>(evaluations_) / seconds_;
    if (search_seconds_ > 0) summary.search_fps = searched_frames_ / search_seconds_;
  }
  return summary;
}

void MetricsOutput::do_finish(bool complete) {
  summary_ = summarize(complete);
  worst_.write(*run_);
  if (truth_->known()) TextFile(run_->file("metrics.json")).write(to_json(summary_.metrics));
  TextFile(run_->file(kSummaryFile)).write(to_json(summary_));
}

}  // namespace hypotrack::internal
