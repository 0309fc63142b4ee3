#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/frame.hpp"
#include "hypotrack/solution.hpp"
#include "output/recording_writer.hpp"
#include "session/opened_scene.hpp"

namespace hypotrack {

/// Records parts of a run's source, each into a new folder `recording_<first frame>` among the
/// run's results. The folder's scene.yaml tracks the recording. It starts where the models were in
/// the first frame, if all were found there, else as the run did. Errors end a recording, not the
/// run.
class Recorder {
 public:
  /// `say` receives lines for the user.
  Recorder(std::filesystem::path folder, std::function<void(const std::string&)> say)
      : folder_(std::move(folder)), say_(std::move(say)) {}

  /// Is called before the first frame. The scene must live until the last recording has ended.
  void open(const OpenedScene& opened);

  /// Adds a frame; the first usable one starts a recording. Returns false if that failed.
  bool add(const Frame& frame, const Solution& solution);
  /// Completes the recording, if there is one.
  void stop();
  /// Returns the number of frames so far; nothing while there is no recording.
  std::optional<int> recorded() const;

 private:
  void start(const Solution& solution);
  void fail(const std::string& why);

  std::filesystem::path folder_;
  std::function<void(const std::string&)> say_;
  const Scene* scene_ = nullptr;
  std::vector<Camera> cameras_;
  double frame_rate_ = 0;
  std::string resolved_;  ///< YAML of the scene
  std::unique_ptr<RecordingWriter> writer_;
  std::filesystem::path recording_;  ///< folder of `writer_`
  int frames_ = 0;
};

}  // namespace hypotrack
