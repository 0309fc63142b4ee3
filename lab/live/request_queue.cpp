#include "lab/live/request_queue.hpp"

namespace hypotrack::internal {
namespace {

thread_local bool t_refuses = false;

}  // namespace

RequestQueue::RequestQueue(std::size_t threads, std::size_t most_waiting)
    : most_waiting_(most_waiting) {
  threads_.reserve(threads);
  try {
    while (threads_.size() < threads) threads_.emplace_back([this] { work(); });
  } catch (...) {
    RequestQueue::shutdown();
    throw;
  }
}

RequestQueue::~RequestQueue() { RequestQueue::shutdown(); }

void RequestQueue::work() {
  while (true) {
    std::function<void()> job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      job = std::move(waiting_.front());
      waiting_.pop_front();
    }
    job();
  }
}

bool RequestQueue::add(std::function<void()>& job) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= most_waiting_) return false;
  waiting_.push_back(std::move(job));
  return true;
}

RequestQueue::Enqueued RequestQueue::enqueue(std::function<void()> job) {
  if (add(job)) {
    changed_.notify_one();
  } else {
    t_refuses = true;
    job();
    t_refuses = false;
  }
  return Enqueued(true);
}

void RequestQueue::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  for (std::thread& each : threads_) each.join();
  threads_.clear();
}

bool RequestQueue::refuses() { return t_refuses; }

}  // namespace hypotrack::internal
