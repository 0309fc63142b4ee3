#pragma once

#include <optional>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"

namespace hypotrack {

/// Yields calibrated frames until it ends.
class HYPOTRACK_API Source {
 public:
  Source() = default;
  virtual ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// The calibrated cameras, in the order of a frame's views; the first is "left".
  virtual const std::vector<Camera>& cameras() const = 0;
  /// Frames per second of the recording.
  virtual double frame_rate() const = 0;
  /// Number of frames, where it is known beforehand.
  virtual std::optional<int> frame_count() const { return std::nullopt; }
  /// The next frame, or nothing at the end. A damaged or missing frame is returned with `problem`
  /// set and no views; it never throws for that.
  virtual std::optional<Frame> next() = 0;
};

}  // namespace hypotrack
