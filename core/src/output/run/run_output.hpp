#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/renderer.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/output.hpp"
#include "output/run/metrics_output.hpp"
#include "output/run_directory.hpp"
#include "plugin/plugin_notes.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Throws ConfigError if two outputs of a run write a file or a column of one name, PluginError if
/// a name is none.
void check_outputs(const std::vector<NamedOutput>& outputs);

/// Which outputs of a run get a frame. Drawing ones took the renderer in Output::begin(): they are
/// slow.
enum class Outputs { all, plain, drawing };

/// Writes the results of a run: run.yaml, what MetricsOutput writes, and the files of the scene's
/// outputs. One thread may add frames to drawing outputs while another adds them to plain ones.
class RunOutput {
 public:
  struct Options {
    std::filesystem::path directory;
    int worst_frames = 3;
    double frame_rate = 30;
    std::string resolved;  ///< content of run.yaml
    std::string backend;
    bool fixed_lag = false;  ///< fixed-lag smoothing: frames come twice, online and smoothed
    std::shared_ptr<const PluginNotes> notes = nullptr;  ///< for the summary; null: none
    std::vector<NamedTermTimes> term_times = {};         ///< for the summary
  };

  /// The scene must outlive the object. Throws as check_outputs() or OutputError, and
  /// then leaves nothing behind.
  RunOutput(const Scene& scene, std::vector<Camera> cameras, Options options,
            std::vector<NamedOutput> outputs);

  ~RunOutput();
  RunOutput(const RunOutput&) = delete;
  RunOutput& operator=(const RunOutput&) = delete;

  /// Returns true if there are drawing outputs.
  bool draws() const;

  /// Returns true if an output wants to see how this frame is searched.
  bool want_search(const Frame& frame) const;
  /// Passes on how a frame was searched, before its solution, to the outputs that want it.
  void add_search(const Frame& frame, const Solution& solution, const SearchRecord& record,
                  Outputs which = Outputs::all);

  /// Adds how the searches of a frame converged, before its solution.
  void add_trace(int frame, const FrameTrace& trace);

  /// Adds the unsmoothed solution of a frame. Call it with fixed-lag smoothing only.
  void add_online(const Frame& frame, const Solution& solution, Outputs which = Outputs::all);

  /// Adds a frame. With fixed-lag smoothing its pictures may be gone.
  void add(const Frame& frame, const Solution& solution, Outputs which = Outputs::all);

  /// Describes what evaluates hypotheses, after it changed, for the summary.
  void set_backend(std::string backend) { metrics_->set_backend(std::move(backend)); }

  /// Closes all files; summary.json, which appears last, says so. Without it the files stay as they
  /// are, or are removed if no frame was added.
  Summary finish(bool complete, const ClockTimes& clock = {});

  bool empty() const { return frames_ == 0; }
  /// Returns the folder of the results.
  const OpenFolder& folder() const { return directory_.folder(); }

 private:
  class Context;

  void begin();
  template <class Function>
  void for_outputs(Outputs which, const Function& function);
  Renderer& renderer(bool of_drawing_outputs);
  bool is_meant(std::size_t output, Outputs which) const;

  const Scene* scene_;
  std::vector<Camera> cameras_;
  Options options_;
  MetricsOutput* metrics_;  ///< the first output
  std::vector<NamedOutput> outputs_;
  std::vector<std::vector<std::string>> columns_;  ///< that each output adds to track.csv
  RunDirectory directory_;
  std::unique_ptr<Renderer> renderer_;              ///< made when there is something to draw
  std::unique_ptr<Renderer> drawing_renderer_;      ///< of the drawing outputs
  std::vector<std::unique_ptr<Context>> contexts_;  ///< of the outputs
  int frames_ = 0;
};

}  // namespace internal
}  // namespace hypotrack
