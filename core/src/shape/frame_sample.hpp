#pragma once

#include <vector>

#include "hypotrack/export.hpp"
#include "shape/image_problem.hpp"
#include "track/tracker.hpp"

namespace hypotrack {

/// Some frames of a run, evenly spread over those that were tracked, however many there will be:
/// whenever twice as many as wanted are held, every second one goes.
class HYPOTRACK_API FrameSample {
 public:
  explicit FrameSample(int wanted) : wanted_(static_cast<std::size_t>(wanted)) {}
  void add(const Frame& frame, const Solution& solution);
  /// At most as many as wanted, in their order.
  std::vector<TrackedFrame> take();

 private:
  void thin();
  std::size_t wanted_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;  // tracked frames
  std::vector<TrackedFrame> held_;
};

}  // namespace hypotrack
