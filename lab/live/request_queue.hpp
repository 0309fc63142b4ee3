#pragma once

#include <httplib.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Answers requests in some threads. Connections beyond a number that wait are refused by the
/// thread that accepts them.
class RequestQueue final : public httplib::TaskQueue {
 public:
  /// Nothing in some versions of httplib.
  using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue(nullptr));

  /// Throws std::system_error if the threads cannot be started.
  RequestQueue(std::size_t threads, std::size_t most_waiting);
  ~RequestQueue() override;
  RequestQueue(const RequestQueue&) = delete;
  RequestQueue& operator=(const RequestQueue&) = delete;

  Enqueued enqueue(std::function<void()> job) override;
  void shutdown() override;

  /// Returns true in a job that is to refuse its connection.
  static bool refuses();

 private:
  void work();
  bool add(std::function<void()>& job);

  const std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;  ///< guarded by the mutex
  bool ends_ = false;                          ///< guarded by the mutex
  std::vector<std::thread> threads_;
};

}  // namespace internal
}  // namespace hypotrack
