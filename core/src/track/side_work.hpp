#pragma once

#include <oneapi/tbb/task_arena.h>

#include <functional>
#include <memory>
#include <string_view>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Does a work in another thread, beside what the owner of this object does meanwhile. The thread
/// is of the arena that begins the first work. In an arena of one thread begin() does each work.
class SideWork {
 public:
  /// `name`, which must outlive the object, is that of its part in profiles and in errors.
  explicit SideWork(std::string_view name) : name_(name) {}
  /// Waits for the work. What it throws is lost.
  ~SideWork();
  SideWork(const SideWork&) = delete;
  SideWork& operator=(const SideWork&) = delete;

  /// Returns whether begin() has a thread for works; else they are done before it returns.
  bool has_thread();
  /// Begins a work after wait().
  void begin(std::function<void()> work);
  /// Waits until no work is left: does it if no thread has begun it, and no other work meanwhile.
  /// Throws, once, what it threw.
  void wait();

 private:
  struct Job;

  std::string_view name_;
  tbb::task_arena arena_;
  std::shared_ptr<Job> job_;  ///< the arena knows it, too; null: none
};

}  // namespace internal
}  // namespace hypotrack
