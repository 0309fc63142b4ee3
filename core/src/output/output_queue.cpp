#include "output/output_queue.hpp"

#include <chrono>
#include <future>
#include <optional>
#include <utility>

namespace hypotrack {
namespace {

constexpr std::size_t kMostWaiting = 8;  // frames with pictures

}  // namespace

OutputQueue::OutputQueue(RunOutput& output) : output_(&output), jobs_(kMostWaiting) {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    while (const std::optional<Job> job = jobs_.pop(stop)) (*job)();
  });
}

void OutputQueue::write(const std::function<void(RunOutput&)>& what) {
  if (failed_) return;
  const auto begin = std::chrono::steady_clock::now();
  try {
    what(*output_);
  } catch (...) {
    failed_ = true;
    const std::lock_guard lock(mutex_);
    error_ = std::current_exception();
  }
  seconds_ =
      seconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void OutputQueue::rethrow() {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void OutputQueue::add_search(Frame frame, Solution solution, SearchRecord record) {
  rethrow();
  jobs_.push(
      [this, frame = std::move(frame), solution = std::move(solution), record = std::move(record)] {
        write([&](RunOutput& output) { output.add_search(frame, solution, record); });
      });
}

void OutputQueue::add_online(Frame frame, Solution solution) {
  rethrow();
  jobs_.push([this, frame = std::move(frame), solution = std::move(solution)] {
    write([&](RunOutput& output) { output.add_online(frame, solution); });
  });
}

void OutputQueue::add(Frame frame, Solution solution) {
  rethrow();
  jobs_.push([this, frame = std::move(frame), solution = std::move(solution)] {
    write([&](RunOutput& output) { output.add(frame, solution); });
  });
}

void OutputQueue::settle() {
  std::promise<void> reached;
  jobs_.push([&reached] { reached.set_value(); });
  reached.get_future().wait();
  rethrow();
}

}  // namespace hypotrack
