#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"

namespace hypotrack {

/// A source of calibrated frames, such as a recording or a live camera.
class HYPOTRACK_API Source {
 public:
  Source() = default;
  virtual ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Returns the calibrated cameras, in the order of a frame's views; the first is "left".
  virtual const std::vector<Camera>& cameras() const = 0;
  /// Returns the recording's frames per second.
  virtual double frame_rate() const = 0;
  /// Returns the number of frames, if known in advance.
  virtual std::optional<int> frame_count() const { return std::nullopt; }
  /// Returns the next frame, or nothing at the end. A damaged or missing frame has `problem` set
  /// and no views; it does not throw. The source does not write into its images afterwards.
  virtual std::optional<Frame> next() = 0;
  /// Returns true if frames that nobody takes are lost, as those of a camera. A run reads other
  /// sources ahead, in a thread of its own.
  virtual bool live() const { return false; }
  /// Returns lines for the user about what was opened, such as a setting that a camera refused.
  virtual std::vector<std::string> notes() const { return {}; }
  /// Returns lines for the user about the frames so far, such as the number of dropped ones. A run
  /// shows them when it ends.
  virtual std::vector<std::string> statistics() const { return {}; }
};

}  // namespace hypotrack
