#include "track/verify/ready_threads.hpp"

#include <oneapi/tbb/parallel_for_each.h>

#include <algorithm>
#include <cassert>
#include <system_error>
#include <utility>

namespace hypotrack::internal {
namespace {

thread_local ReadyThreads* of_this_thread = nullptr;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace

ReadyThreads::ReadyThreads(int count) {
  try {
    for (int i = 0; i < count; ++i) threads_.emplace_back([this] { live(); });
  } catch (const std::system_error&) {  // a limit of threads: the others help, or none
  }
}

ReadyThreads::~ReadyThreads() {
  state_ = State::ended;
  state_.notify_all();
}

ReadyThreads::Awake::Awake(ReadyThreads* threads) : threads_(threads) {
  if (!threads_) return;
  of_this_thread = threads_;
  threads_->state_ = State::awake;
  threads_->state_.notify_all();
}

ReadyThreads::Awake::~Awake() {
  if (!threads_) return;
  threads_->state_ = State::asleep;
  of_this_thread = nullptr;
}

void ReadyThreads::live() {
  while (state_ != State::ended) {
    state_.wait(State::asleep);
    while (state_ == State::awake)
      if (!help()) pause();
  }
}

bool ReadyThreads::help() {
  std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
  do {
    if ((ticket & 0xFFFF) >= (ticket >> 16 & 0xFFFF)) return false;
  } while (!ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel));
  try {
    (*works_[ticket & 0xFFFF])();
  } catch (...) {
    if (!failed_.test_and_set()) failure_ = std::current_exception();
  }
  left_.fetch_sub(1, std::memory_order_release);
  return true;
}

void ReadyThreads::run(std::initializer_list<Work> works) {
  assert(works.size() <= kMostWorks);
  std::ranges::transform(works, works_.begin(), [](const Work& work) { return &work; });
  left_.store(static_cast<int>(works.size()), std::memory_order_relaxed);
  const std::uint64_t turn = (ticket_.load(std::memory_order_relaxed) >> 32) + 1;
  ticket_.store(turn << 32 | works.size() << 16, std::memory_order_release);
  of_this_thread = nullptr;  // works within a work are not for the others
  while (help()) {
  }
  while (left_.load(std::memory_order_acquire) > 0) pause();
  of_this_thread = this;
  failed_.clear();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void run_together(std::initializer_list<ReadyThreads::Work> works) {
  if (of_this_thread) return of_this_thread->run(works);
  oneapi::tbb::parallel_for_each(works, [](const ReadyThreads::Work& work) { work(); });
}

}  // namespace hypotrack::internal
