#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/api/stop.hpp"

namespace hypotrack {

/// Tracks a scene through frames that the caller passes. Session::tracker() makes one.
///
/// Use one tracker per sequence of frames, from one thread at a time. It ignores fixed-lag
/// smoothing (`smoothing.fixed_lag`), which only Session::run() does.
class HYPOTRACK_API Tracker {
 public:
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;
  ~Tracker();

  /// Finds the scene in the next frame. Without views, the frame counts as missing.
  ///
  /// A frame has one view per camera, in the order of cameras(). Indices and times increase from
  /// frame to frame. Throws DataError if the frame does not fit the cameras or the frames before.
  /// Throws ConfigError at the first frame if `init.from` is `truth` and it has none. A tracker
  /// that could not start refuses all further frames. Learning goes on after it returned, without
  /// the pictures; a later call throws its errors. After the last call they are lost.
  ///
  /// Throws Stopped within about 0.2 s once `stop` returns true. The frame then counts as missing:
  /// go on with a later one.
  Solution track(const Frame& frame, const StopTest& stop = {});

  /// Returns the tracked models; names and order of a solution's state and landmarks are theirs.
  const Scene& scene() const;
  const std::vector<Camera>& cameras() const;
  /// Describes what evaluates hypotheses: the CPU and its threads, or the GPU.
  std::string backend() const;
  /// Returns lines for the user that the plugins told since the last call, each text once.
  std::vector<std::string> take_notes();

 private:
  friend class Session;
  struct Impl;
  explicit Tracker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
