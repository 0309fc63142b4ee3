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
#include "track/tracker.hpp"

namespace hypotrack {

class OverlayVideo;

/// Writes what a run leaves behind: track.csv, joints.csv, overlay.mp4, run.yaml and summary.json;
/// online.csv and online_joints.csv if hindsight changes what was found; uncertainty.csv if the
/// tracker says how far off landmarks may be; with ground truth also truth_states.csv,
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
    bool hindsight = false;  ///< frames come twice: as they were found, and changed
  };

  /// The scene must outlive it. Throws OutputError or DeviceError and then leaves nothing behind.
  RunOutput(const Scene& scene, const Camera& camera, Options options);

  ~RunOutput();
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// With hindsight, what was found in a frame: for the online tables and the overlay.
  void add_online(const Frame& frame, const Solution& solution);

  /// Adds a frame (with hindsight, its pictures may be gone) and returns its error in metres (NaN
  /// without ground truth or a solution).
  double add(const Frame& frame, const Solution& solution);

  /// Closes everything and gives the files their names. Without it the unfinished files stay, or go
  /// if no frame was added.
  Summary finish(bool complete);

  bool empty() const { return frames_ == 0; }

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
