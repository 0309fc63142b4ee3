#pragma once

#include <atomic>
#include <exception>
#include <optional>
#include <thread>

#include "base/bounded_queue.hpp"
#include "base/exported.hpp"
#include "hypotrack/plugin/source.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads frames of a source in a thread of its own while the caller works on earlier ones. A live
/// source is asked in the caller's thread: frames read ahead would be old.
class ReadAhead {
 public:
  /// Reads up to `limit` frames by up to `threads` threads. The source must outlive the object.
  ReadAhead(Source& source, std::optional<int> limit, int threads);
  /// Waits for the frame that is being read.
  ~ReadAhead() = default;
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// Returns the next frame, or nothing at the end. Throws what the source threw in its place.
  std::optional<Frame> next();

  /// Returns how long the source has worked, in seconds.
  double seconds() const { return seconds_; }

 private:
  struct Item {
    std::optional<Frame> frame;
    std::exception_ptr error;
  };

  std::optional<Frame> timed_next();
  void read(const std::stop_token& stop, std::optional<int> limit);

  Source* source_;
  std::atomic<double> seconds_ = 0;
  BoundedQueue<Item> items_;
  std::jthread thread_;  ///< not started for a live source; ends before what it uses
};

}  // namespace internal
}  // namespace hypotrack
