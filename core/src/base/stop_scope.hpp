#pragma once

#include "base/exported.hpp"
#include "hypotrack/api/stop.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Makes a test that of check_stop() in the calling thread, during this object's lifetime. An empty
/// test leaves the thread's as it is.
class StopScope {
 public:
  /// The test must outlive the object.
  explicit StopScope(const StopTest& test);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const StopTest* before_;
};

/// The calling thread's check_stop() for work that it shares with other threads.
class StopCheck {
 public:
  StopCheck();
  /// Throws Stopped as check_stop() would in the thread that made this object.
  void operator()() const;

 private:
  const StopTest* test_;
};

}  // namespace internal
}  // namespace hypotrack
