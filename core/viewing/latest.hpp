#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

namespace hypotrack {

/// Holds the newest of a series of values for any number of readers. A reader that is late skips
/// values. All functions may be called from several threads.
template <class T>
class Latest {
 public:
  struct Entry {
    std::uint64_t number = 0;  ///< counts the values from 1; 0: none yet
    std::shared_ptr<const T> value;
  };

  void put(T value) {
    const std::lock_guard lock(mutex_);
    entry_ = {entry_.number + 1, std::make_shared<const T>(std::move(value))};
    changed_.notify_all();
  }

  Entry get() const {
    const std::lock_guard lock(mutex_);
    return entry_;
  }

  /// Waits for a value after number `seen`. Returns the newest one, which is not after `seen` if
  /// the time is over or nothing more will come.
  Entry wait_after(std::uint64_t seen, std::chrono::milliseconds time) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, time, [&] { return closed_ || entry_.number > seen; });
    return entry_;
  }

  /// Says that nothing more will come.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Entry entry_;
  bool closed_ = false;
};

}  // namespace hypotrack
