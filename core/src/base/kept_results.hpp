#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <list>
#include <map>
#include <mutex>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A file as it is now: its path, size and time. A file that is written anew has another one.
using FileVersion = std::tuple<std::string, std::uintmax_t, std::filesystem::file_time_type>;

/// Returns the version of a file; that of a missing file or an empty path has no size.
inline FileVersion version_of(const std::filesystem::path& file) {
  if (file.empty()) return {};
  std::error_code size_error, time_error, path_error;
  return {std::filesystem::absolute(file, path_error).string(),
          std::filesystem::file_size(file, size_error),
          std::filesystem::last_write_time(file, time_error)};
}

/// Keeps results for whoever wants them again, in any thread: up to a total weight, the most
/// recently wanted ones.
template <class Key, class Value>
class KeptResults {
 public:
  /// `weight` returns what a result adds to the total; 0: it is not kept.
  explicit KeptResults(std::function<std::size_t(const Value&)> weight)
      : weight_(std::move(weight)) {}

  /// Keeps results from now on. 0: no more.
  void keep(std::size_t most) {
    const std::lock_guard lock(mutex_);
    most_ = most;
    make_room();
  }

  /// Returns whether results are kept.
  bool keeps() const { return most_ > 0; }

  /// Returns a kept result, or makes it with `make` while others who want it wait. Throws what
  /// `make` throws.
  template <class Make>
  Value get(const Key& key, const Make& make) {
    std::promise<Value> promise;
    {
      std::unique_lock lock(mutex_);
      if (const auto known = entries_.find(key); known != entries_.end()) {
        order_.splice(order_.end(), order_, known->second.place);
        const std::shared_future<Value> result = known->second.result;
        lock.unlock();
        return result.get();
      }
      entries_.emplace(key, Entry{promise.get_future().share(), order_.insert(order_.end(), key)});
    }
    try {
      Value value = make();
      promise.set_value(value);
      settle(key, weight_(value));
      return value;
    } catch (...) {
      promise.set_exception(std::current_exception());
      settle(key, 0);
      throw;
    }
  }

 private:
  struct Entry {
    std::shared_future<Value> result;
    typename std::list<Key>::iterator place;
    std::size_t weight = 0;  ///< 0 while it is made
  };

  void settle(const Key& key, std::size_t weight) {
    const std::lock_guard lock(mutex_);
    const auto entry = entries_.find(key);
    entry->second.weight = weight;
    total_ += weight;
    if (weight == 0) remove(entry);
    make_room();
  }

  void make_room() {
    for (auto oldest = order_.begin(); total_ > most_ && oldest != order_.end();) {
      const auto entry = entries_.find(*oldest++);
      if (entry->second.weight > 0) remove(entry);
    }
  }

  void remove(typename std::map<Key, Entry>::iterator entry) {
    total_ -= entry->second.weight;
    order_.erase(entry->second.place);
    entries_.erase(entry);
  }

  std::function<std::size_t(const Value&)> weight_;
  std::mutex mutex_;
  std::atomic<std::size_t> most_ = 0;
  std::size_t total_ = 0;
  std::map<Key, Entry> entries_;
  std::list<Key> order_;  ///< the one that was wanted last is last
};

}  // namespace internal
}  // namespace hypotrack
