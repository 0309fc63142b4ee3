#pragma once

#include <vector>

#include "base/exported.hpp"
#include "shape/image_problem.hpp"
#include "track/loop/scene_tracker.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Samples the tracked frames of a run evenly, without knowing their number. Whenever it holds
/// twice as many frames as wanted, it drops every second one.
class FrameSample {
 public:
  explicit FrameSample(int wanted) : wanted_(static_cast<std::size_t>(wanted)) {}
  void add(const Frame& frame, const Solution& solution);
  /// Returns the sampled frames in their order, at most as many as wanted.
  std::vector<TrackedFrame> take();

 private:
  void thin();
  std::size_t wanted_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;  // tracked frames
  std::vector<TrackedFrame> held_;
};

}  // namespace internal
}  // namespace hypotrack
