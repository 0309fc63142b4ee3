#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "common.hpp"
#include "hypotrack/tracker.hpp"
#include "solution.hpp"

namespace hypotrack::python {

/// A tracker that Python owns.
class PythonTracker {
 public:
  explicit PythonTracker(Tracker tracker)
      : tracker_(std::make_unique<Tracker>(std::move(tracker))),
        scene_(std::make_shared<Scene>(tracker_->scene())) {}
  ~PythonTracker() { end_without_gil(tracker_); }
  PythonTracker(const PythonTracker&) = delete;
  PythonTracker& operator=(const PythonTracker&) = delete;

  /// Tracks a frame; an index below 0 is the next one.
  NamedSolution track(Frame frame);

  const std::shared_ptr<Scene>& scene() const { return scene_; }
  const Tracker& tracker() const { return *tracker_; }

 private:
  std::unique_ptr<Tracker> tracker_;
  std::shared_ptr<Scene> scene_;
  std::atomic<bool> busy_ = false;
  int next_ = 0;
};

}  // namespace hypotrack::python
