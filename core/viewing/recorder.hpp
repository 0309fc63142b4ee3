#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/open_folder.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/solution.hpp"
#include "output/recording/recording_writer.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack {

/// Records parts of a run's source, each into a new folder `recording_<first frame>` among the
/// run's results. The folder's scene.yaml tracks the recording. It starts where the models were in
/// the first frame, if all were found there, else as the run did. Errors end a recording, not the
/// run.
class Recorder {
 public:
  /// `say` receives lines for the user.
  explicit Recorder(std::function<void(const std::string&)> say) : say_(std::move(say)) {}

  /// Is called before the first frame. The scene must live until the last recording has ended.
  void open(const OpenedScene& opened);

  /// Names the folder of the results, which must outlive the recordings.
  void set_folder(const OpenFolder& folder) { folder_ = &folder; }

  /// Adds a frame; the first usable one starts a recording. Returns false if that failed.
  bool add(const Frame& frame, const Solution& solution);
  /// Completes the recording, if there is one.
  void stop();
  /// Returns the number of frames so far; nothing while there is no recording.
  std::optional<int> recorded() const;

 private:
  void start(const Solution& solution);
  void fail(const std::string& why);

  const OpenFolder* folder_ = nullptr;
  std::function<void(const std::string&)> say_;
  const Scene* scene_ = nullptr;
  std::vector<Camera> cameras_;
  double frame_rate_ = 0;
  std::string resolved_;  ///< YAML of the scene
  std::unique_ptr<RecordingWriter> writer_;
  int frames_ = 0;
};

}  // namespace hypotrack
