#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/scene.hpp"
#include "viewing/live_frame.hpp"

namespace hypotrack {

/// Shows a run while it tracks, such as a web page or a window. Functions are called from the
/// thread that tracks and return without waiting for the user.
class Viewer {
 public:
  Viewer() = default;
  virtual ~Viewer() = default;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Is called when the scene is open. The scene lives until end(). Throws DeviceError if it cannot
  /// be drawn.
  virtual void open(const Scene& scene, const std::vector<Camera>& cameras) = 0;
  /// Is called before the first frame, with the number of frames if it is known.
  virtual void begin(std::optional<int> frames) = 0;
  virtual void frame(const LiveFrame& frame) = 0;
  virtual void set_status(const LiveStatus& status) = 0;
  /// Shows a line of text.
  virtual void say(const std::string& text) = 0;
  /// Is called after the last frame. What is shown stays until the object's end.
  virtual void end() = 0;
};

}  // namespace hypotrack
