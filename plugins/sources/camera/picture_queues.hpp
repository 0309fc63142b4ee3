#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "device.hpp"

namespace hypotrack::live {

/// Counts of a device since the first pair.
struct DeviceCounts {
  int pictures = 0;    ///< whole ones
  int dropped = 0;     ///< whole ones that are in no pair
  int damaged = 0;     ///< cannot be decoded
  int reconnects = 0;  ///< times that it was opened again
};

/// Holds the newest pictures of each device between the capture threads and the source. All members
/// may be called from any thread.
class PictureQueues {
 public:
  /// Makes a queue for each device, named for messages.
  explicit PictureQueues(const std::vector<std::string>& names);

  // For the capture thread of a device.
  void opened(std::size_t device, double stated_rate, std::vector<std::string> refused);
  void add(std::size_t device, Picture picture);
  void add_damaged(std::size_t device);
  /// Notes why a device gives no pictures.
  void lost(std::size_t device, std::string problem);
  void ended(std::size_t device);
  /// Waits. Returns false at once if the capture shall end.
  bool sleep(double seconds);
  bool stopped();

  // For the source.
  /// Waits until `count` pictures of every device arrived, a device has a problem before its first,
  /// or the deadline (of now()) passed. Returns the problem.
  std::string wait_for_first(int count, std::int64_t deadline);
  /// Returns the pictures per second that the device states, or those so far; 0 if there are less
  /// than two.
  double rate(std::size_t device);
  /// Returns the size of a device's pictures; empty if there are none.
  cv::Size size(std::size_t device);
  /// Waits for pictures of all devices, one each, that were taken after `after` and at most
  /// `tolerance` nanoseconds apart. Returns the newest; no picture if the deadline passes before.
  std::vector<Picture> take(std::int64_t after, std::int64_t tolerance, std::int64_t deadline);
  /// Says why take() found nothing.
  std::string problem(std::int64_t tolerance);
  DeviceCounts counts(std::size_t device);
  std::vector<std::string> refused(std::size_t device);
  /// Adds a line for the user to refused().
  void tell(std::size_t device, std::string line);
  /// Tells the capture threads to end and waits for them until the deadline. Returns which ended.
  std::vector<bool> stop(std::int64_t deadline);

 private:
  struct Queue {
    std::string name;
    std::deque<Picture> waiting;
    cv::Size size;
    std::int64_t first = 0, last = 0;  ///< stamps
    double stated_rate = 0;            ///< 0: unknown
    int arrived = 0;
    int times_opened = 0;
    DeviceCounts counts;
    std::string problem;
    std::vector<std::string> refused;
    bool ended = false;
  };

  std::optional<std::vector<std::size_t>> places(std::int64_t tolerance) const;
  static void forget(Queue& device, std::int64_t until);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Queue> queues_;  ///< and all below: guarded by the mutex
  bool any_pair_ = false;
  bool stopped_ = false;
};

}  // namespace hypotrack::live
