#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/api/tracker.hpp"

namespace hypotrack::python {

/// A solution with the scene that it is of, and what was told since the one before.
struct NamedSolution {
  Solution solution;
  std::shared_ptr<Scene> scene;
  std::vector<std::string> notes = {};
};

/// A tracker that Python owns.
class PythonTracker {
 public:
  /// The caller has the GIL.
  explicit PythonTracker(Tracker tracker);
  ~PythonTracker();
  PythonTracker(const PythonTracker&) = delete;
  PythonTracker& operator=(const PythonTracker&) = delete;

  /// Tracks a frame; an index below 0 is the next one.
  NamedSolution track(Frame frame);

  const std::shared_ptr<Scene>& scene() const { return scene_; }
  std::vector<Camera> cameras();
  std::string backend();

  /// Ends the trackers that are not at work, while their threads can still call Python. The caller
  /// has the GIL.
  static void end_all();

 private:
  static std::set<PythonTracker*>& all();
  Tracker& tracker() const;

  std::unique_ptr<Tracker> tracker_;
  std::shared_ptr<Scene> scene_;
  std::atomic<bool> busy_ = false;
  int next_ = 0;
};

}  // namespace hypotrack::python
