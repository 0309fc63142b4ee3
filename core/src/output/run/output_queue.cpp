#include "output/run/output_queue.hpp"

#include <chrono>
#include <future>
#include <utility>

namespace hypotrack::internal {
namespace {

constexpr std::size_t kMostWaiting = 8;  // frames with pictures

}  // namespace

OutputQueue::OutputQueue(RunOutput& output) : output_(&output), waiting_(kMostWaiting) {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    while (const auto job = waiting_.pop(stop)) (*job)();
  });
}

void OutputQueue::write(const Job& job, Outputs which) {
  const auto begin = std::chrono::steady_clock::now();
  job(*output_, which);
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void OutputQueue::draw(const Job& job) {
  if (failed_) return;
  try {
    write(job, Outputs::drawing);
  } catch (...) {
    failed_ = true;
    const std::lock_guard lock(mutex_);
    error_ = std::current_exception();
  }
}

void OutputQueue::give(Job job) {
  rethrow();
  write(job, Outputs::plain);
  if (output_->draws()) waiting_.push([this, job = std::move(job)] { draw(job); });
}

void OutputQueue::rethrow() {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void OutputQueue::add_search(Frame frame, Solution solution, SearchRecord record) {
  give(
      [frame = std::move(frame), solution = std::move(solution), record = std::move(record)](
          RunOutput& output, Outputs which) { output.add_search(frame, solution, record, which); });
}

void OutputQueue::add_trace(int frame, const FrameTrace& trace) {
  rethrow();
  write([&](RunOutput& output, Outputs) { output.add_trace(frame, trace); }, Outputs::plain);
}

void OutputQueue::add_online(Frame frame, Solution solution) {
  give([frame = std::move(frame), solution = std::move(solution)](
           RunOutput& output, Outputs which) { output.add_online(frame, solution, which); });
}

void OutputQueue::add(Frame frame, Solution solution) {
  give([frame = std::move(frame), solution = std::move(solution)](
           RunOutput& output, Outputs which) { output.add(frame, solution, which); });
}

void OutputQueue::settle() {
  std::promise<void> reached;
  waiting_.push([&reached] { reached.set_value(); });
  reached.get_future().wait();
  rethrow();
}

}  // namespace hypotrack::internal
