#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "cost/term_times.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/output.hpp"
#include "output/metrics/metrics.hpp"
#include "output/metrics/status_metrics.hpp"
#include "output/run/summary.hpp"
#include "output/run/trace_output.hpp"
#include "output/run/truth_output.hpp"
#include "output/run/uncertainty_output.hpp"
#include "output/run/worst_frames.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Measures a run: summary.json and, with predicted uncertainty, uncertainty.csv. With ground
/// truth: truth_states.csv, truth_landmarks.csv, errors.csv, metrics.json and worst_<frame>.jpg. Of
/// traced frames: trace.csv and, with a true state, truth_costs.csv.
class MetricsOutput final : public Output {
 public:
  /// `backend` describes what evaluates hypotheses. `notes`: what plugins tell the user; null:
  /// none.
  MetricsOutput(int worst_frames, std::string backend,
                std::shared_ptr<const PluginNotes> notes = nullptr,
                std::vector<NamedTermTimes> term_times = {})
      : backend_(std::move(backend)),
        notes_(std::move(notes)),
        term_times_(std::move(term_times)),
        worst_(worst_frames) {}

  /// Takes how the searches of a frame converged, before its solution. Throws OutputError.
  void trace(int frame, const FrameTrace& trace);

  /// Takes how long the run took. Call it before finish().
  void set_clock(const ClockTimes& clock) { clock_ = clock; }

  /// Describes what evaluates hypotheses, after it changed.
  void set_backend(std::string backend) { backend_ = std::move(backend); }

  /// Returns the summary of a finished run.
  const Summary& summary() const { return summary_; }

 private:
  std::vector<std::string> do_file_names() const override;
  void do_begin(OutputContext& run) override;
  void do_frame(const Frame& frame, const Solution& solution) override;
  void do_finish(bool complete) override;

  void remember_if_bad(const Frame& frame, const Solution& solution, double error,
                       const ScenePose& truth, const Eigen::Matrix3Xd& landmarks);
  Summary summarize(bool complete) const;

  OutputContext* run_ = nullptr;
  std::string backend_;
  std::shared_ptr<const PluginNotes> notes_;
  std::vector<NamedTermTimes> term_times_;
  std::optional<MetricsCollector> metrics_;
  std::optional<TruthOutput> truth_;
  std::optional<UncertaintyOutput> uncertainty_;
  std::optional<TraceOutput> trace_;
  WorstFrames worst_;
  Summary summary_;
  ClockTimes clock_;
  int frames_ = 0;
  double seconds_ = 0;
  double search_seconds_ = 0;  ///< of frames that are not tracked
  int searched_frames_ = 0;
  std::int64_t evaluations_ = 0;
  std::map<std::string, int> faults_;
};

/// Returns a solution's statuses of the frame and of each model that has landmarks.
FrameStatuses statuses_of(const Scene& scene, const Solution& solution);

}  // namespace internal
}  // namespace hypotrack
