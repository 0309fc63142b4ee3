#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "base/bounded_queue.hpp"
#include "base/exported.hpp"
#include "output/run/run_output.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Gives the frames of a run to its outputs, in order: to plain ones at once, to drawing ones in a
/// thread of their own. While many frames wait for that, the caller waits.
class OutputQueue {
 public:
  /// The output must outlive the object, and is used by nobody else until settle() returns.
  explicit OutputQueue(RunOutput& output);
  /// Drops what waits.
  ~OutputQueue() = default;
  OutputQueue(const OutputQueue&) = delete;
  OutputQueue& operator=(const OutputQueue&) = delete;

  /// As those of RunOutput. Each throws what a drawing output threw for an earlier frame, once;
  /// nothing is drawn after that.
  void add_search(Frame frame, Solution solution, SearchRecord record);
  void add_trace(int frame, const FrameTrace& trace);
  void add_online(Frame frame, Solution solution);
  void add(Frame frame, Solution solution);

  /// Waits until all that was added is written. Throws like add().
  void settle();

  /// Returns how long the outputs have worked, in seconds.
  double seconds() const { return seconds_; }

 private:
  using Job = std::function<void(RunOutput&, Outputs)>;

  void give(Job job);
  void write(const Job& job, Outputs which);
  /// Is called in the thread.
  void draw(const Job& job);
  void rethrow();

  RunOutput* output_;
  std::atomic<double> seconds_ = 0;
  std::mutex mutex_;
  std::exception_ptr error_;  ///< guarded by the mutex; null after it was thrown
  bool failed_ = false;       ///< of the thread
  BoundedQueue<std::function<void()>> waiting_;
  std::jthread thread_;  ///< ends before what it uses
};

}  // namespace internal
}  // namespace hypotrack
