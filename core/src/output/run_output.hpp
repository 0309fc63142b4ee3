#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/scene.hpp"
#include "output/metrics.hpp"
#include "output/run_directory.hpp"
#include "output/text_file.hpp"
#include "track/tracker.hpp"

namespace hypotrack {

class OverlayVideo;

/// What a run amounts to; summary.json.
struct Summary {
  bool complete = false;  ///< false if the run was interrupted or ended by an error
  int frames = 0;
  int lost_frames = 0;       ///< status lost or, with ground truth, off by more than 40 mm
  int uncertain_frames = 0;
  int missing_frames = 0;
  double fps = 0;            ///< frames per second of tracking: images in, state out
  double evaluations_per_second = 0;
  std::string backend;
  std::optional<ErrorStatistics> errors;
};
HYPOTRACK_API std::string to_json(const Summary& summary);

/// Writes what a run leaves behind: track.csv, joints.csv, errors.csv (with ground truth),
/// overlay.mp4, run.yaml and summary.json.
class HYPOTRACK_API RunOutput {
 public:
  struct Options {
    std::filesystem::path directory;
    bool overlay = true;
    double frame_rate = 30;
    std::string resolved;  ///< content of run.yaml
    std::string backend;
  };

  /// The scene must outlive it. Throws OutputError or DeviceError and then leaves nothing behind.
  RunOutput(const Scene& scene, const Camera& camera, Options options);

  ~RunOutput();
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// Adds a frame and returns its error in metres (NaN without ground truth).
  double add(const Frame& frame, const Solution& solution);

  /// Closes everything and gives the files their names. Without it the unfinished files stay, or go
  /// if no frame was added.
  Summary finish(bool complete);

  bool empty() const { return counts_.frames == 0; }

 private:
  void write_headers();
  Summary summarize(bool complete) const;

  const Scene* scene_;
  Options options_;
  RunDirectory directory_;
  TextFile track_;
  TextFile joints_;
  std::optional<TextFile> errors_;  ///< opened at the first frame with a truth
  std::unique_ptr<OverlayVideo> overlay_;
  std::vector<double> frame_errors_;
  Summary counts_;
  double seconds_ = 0;
  std::int64_t evaluations_ = 0;
};

}  // namespace hypotrack
