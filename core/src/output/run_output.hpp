#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/text_file.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/renderer.hpp"
#include "hypotrack/scene.hpp"
#include "output/metrics/metrics.hpp"
#include "output/run_directory.hpp"
#include "output/summary.hpp"
#include "output/truth_output.hpp"
#include "output/uncertainty_output.hpp"
#include "output/worst_frames.hpp"
#include "track/scene_tracker.hpp"

namespace hypotrack {

class OverlayVideo;

/// Writes the results of a run: track.csv, joints.csv, overlay.mp4, run.yaml and summary.json.
///
/// With fixed-lag smoothing: online.csv and online_joints.csv with the unsmoothed solutions. With
/// predicted uncertainty: uncertainty.csv. With ground truth: truth_states.csv,
/// truth_landmarks.csv, errors.csv, metrics.json and worst_<frame>.jpg.
class HYPOTRACK_API RunOutput {
 public:
  struct Options {
    std::filesystem::path directory;
    bool overlay = true;
    int worst_frames = 3;
    double frame_rate = 30;
    std::string resolved;  ///< content of run.yaml
    std::string backend;
    bool fixed_lag = false;  ///< fixed-lag smoothing: frames come twice, online and smoothed
  };

  /// The scene must outlive the output. Throws OutputError or DeviceError and then leaves nothing
  /// behind.
  RunOutput(const Scene& scene, const Camera& camera, Options options);

  ~RunOutput();
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// Adds the unsmoothed solution of a frame, for the online tables and the overlay.
  void add_online(const Frame& frame, const Solution& solution);

  /// Adds a frame and returns its error in metres (NaN without ground truth or a solution). With
  /// fixed-lag smoothing its pictures may be gone.
  double add(const Frame& frame, const Solution& solution);

  /// Closes all files and renames them. Without it the unfinished files stay, or are removed if no
  /// frame was added.
  Summary finish(bool complete);

  bool empty() const { return frames_ == 0; }
  const Scene& scene() const { return *scene_; }

 private:
  Renderer& renderer();
  void remember_if_bad(const Frame& frame, const Solution& solution, double error,
                       const ScenePose& truth, const Eigen::Matrix3Xd& landmarks);
  Summary summarize(bool complete) const;

  const Scene* scene_;
  Camera camera_;
  Options options_;
  RunDirectory directory_;
  TextFile track_;
  std::optional<TextFile> online_;
  std::optional<TextFile> online_joints_;
  TextFile joints_;
  std::unique_ptr<Renderer> renderer_;  ///< made when there is something to draw
  std::unique_ptr<OverlayVideo> overlay_;
  MetricsCollector metrics_;
  TruthOutput truth_;
  UncertaintyOutput uncertainty_;
  WorstFrames worst_;
  int frames_ = 0;
  double seconds_ = 0;
  double search_seconds_ = 0;  ///< of frames that are not tracked
  int searched_frames_ = 0;
  std::int64_t evaluations_ = 0;
};

}  // namespace hypotrack
