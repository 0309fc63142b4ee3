#include "viewing/run_controls.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace hypotrack {

void RunControls::pause() {
  const std::lock_guard lock(mutex_);
  paused_ = true;
  steps_ = 0;
}

void RunControls::resume() {
  const std::lock_guard lock(mutex_);
  paused_ = false;
  steps_ = 0;
  changed_.notify_all();
}

void RunControls::toggle_pause() {
  const std::lock_guard lock(mutex_);
  paused_ = !paused_;
  steps_ = 0;
  changed_.notify_all();
}

void RunControls::step() {
  constexpr int kMost = 1000;  // steps that wait
  const std::lock_guard lock(mutex_);
  paused_ = true;
  steps_ = std::min(steps_ + 1, kMost);
  changed_.notify_all();
}

void RunControls::ask_for_restart() {
  const std::lock_guard lock(mutex_);
  restart_ = true;
}

void RunControls::ask_for_snapshot() {
  const std::lock_guard lock(mutex_);
  snapshot_ = true;
  changed_.notify_all();
}

void RunControls::toggle_recording() {
  const std::lock_guard lock(mutex_);
  recording_ = !recording_;
}

void RunControls::ask_for_end() {
  const std::lock_guard lock(mutex_);
  end_ = true;
  changed_.notify_all();
}

bool RunControls::paused() const {
  const std::lock_guard lock(mutex_);
  return paused_;
}

bool RunControls::recording_wanted() const {
  const std::lock_guard lock(mutex_);
  return recording_;
}

bool RunControls::end_wanted() const {
  const std::lock_guard lock(mutex_);
  return end_;
}

void RunControls::wait_while_paused(const std::function<bool()>& meanwhile) {
  constexpr std::chrono::milliseconds kPeriod{20};
  std::unique_lock lock(mutex_);
  while (paused_ && !end_) {
    if (steps_ > 0) {
      --steps_;
      return;
    }
    lock.unlock();
    const bool go_on = meanwhile();
    lock.lock();
    if (!go_on) return;
    changed_.wait_for(lock, kPeriod, [&] { return !paused_ || steps_ > 0 || snapshot_ || end_; });
  }
}

bool RunControls::take_restart() {
  const std::lock_guard lock(mutex_);
  return std::exchange(restart_, false);
}

bool RunControls::take_snapshot() {
  const std::lock_guard lock(mutex_);
  return std::exchange(snapshot_, false);
}

void RunControls::cancel_recording() {
  const std::lock_guard lock(mutex_);
  recording_ = false;
}

}  // namespace hypotrack
