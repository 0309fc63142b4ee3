#pragma once

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "output/run/output_queue.hpp"
#include "track/loop/scene_tracker.hpp"
#include "track/smooth/fixed_lag_smoother.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Passes a run's frames to its output: at once or, with fixed-lag smoothing, when their states are
/// settled.
class FixedLagOutput {
 public:
  /// Scene and output must outlive the object. Without a smoother (null) frames are written as they
  /// come.
  FixedLagOutput(const Scene& scene, std::unique_ptr<FixedLagSmoother> smoother,
                 OutputQueue& output)
      : scene_(&scene), smoother_(std::move(smoother)), output_(&output) {}

  /// Adds the frame that `tracker` has just solved.
  void add(const SceneTracker& tracker, const Frame& frame, const Solution& solution);

  /// Smooths and writes the frames that still wait.
  void finish();
  /// Writes the frames that still wait as they are. Use it after an error.
  void finish_unchanged();

  /// Returns the error after which smoothing left a device; empty: there was none.
  std::string device_error() const { return smoother_ ? smoother_->device_error() : std::string(); }

 private:
  struct Waiting {
    Frame frame;  ///< without its pictures
    Solution solution;
  };
  void write(const std::vector<FixedLagSmoother::Settled>& settled);

  const Scene* scene_;
  std::unique_ptr<FixedLagSmoother> smoother_;
  OutputQueue* output_;
  std::deque<Waiting> waiting_;
};

}  // namespace internal
}  // namespace hypotrack
