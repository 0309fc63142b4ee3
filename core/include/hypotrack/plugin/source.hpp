#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/plugin_object.hpp"

namespace hypotrack {

class Scene;

/// A source of calibrated frames, such as a recording or a live camera.
class HYPOTRACK_API Source : public PluginObject {
 public:
  Source();
  ~Source() override;

  /// Returns the calibrated cameras, in the order of a frame's views; the first is "left".
  const std::vector<Camera>& cameras() const { return do_cameras(); }
  /// Returns the recording's frames per second.
  double frame_rate() const { return do_frame_rate(); }
  /// Returns the number of frames, if known in advance.
  std::optional<int> frame_count() const { return do_frame_count(); }
  /// Returns the next frame, or nothing at the end. A damaged or missing frame has `problem` set
  /// and no views; it does not throw. The source does not write into its images afterwards.
  ///
  /// Corrects times that do not grow, and sets Frame::fault. Throws DataError, naming source and
  /// frame, if numbers do not grow, pictures do not fit their cameras, only some frames have a
  /// stamp, or the ground truth does not fit the scene of check_for().
  std::optional<Frame> next();
  /// Returns true if frames that nobody takes are lost, as those of a camera. A run reads other
  /// sources ahead, in a thread of its own.
  bool live() const { return do_live(); }
  /// Returns lines for the user about what was opened, such as a setting that a camera refused.
  std::vector<std::string> notes() const { return do_notes(); }
  /// Returns lines for the user about the frames so far, such as the number of dropped ones.
  /// Without any, one of a scene's source that ended before its announced end. A run shows them
  /// when it ends.
  std::vector<std::string> statistics() const;

  /// Checks cameras and frame rate now, and from now on whether ground truth fits a scene. Throws
  /// DataError, naming the source.
  void check_for(const Scene& scene);

 protected:
  // What plugins write: each function as the public one of its name says. Frames of do_next() need
  // no check of their own.
  virtual const std::vector<Camera>& do_cameras() const = 0;
  virtual double do_frame_rate() const = 0;
  virtual std::optional<int> do_frame_count() const { return std::nullopt; }
  virtual std::optional<Frame> do_next() = 0;
  virtual bool do_live() const { return false; }
  virtual std::vector<std::string> do_notes() const { return {}; }
  virtual std::vector<std::string> do_statistics() const { return {}; }

 private:
  struct Progress;
  std::unique_ptr<Progress> progress_;
};

}  // namespace hypotrack
