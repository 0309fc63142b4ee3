#pragma once

#include "base/exported.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Makes a clock that of the searches on this thread, while it lives.
class ClockScope {
 public:
  explicit ClockScope(SearchClock clock);
  ~ClockScope();
  ClockScope(const ClockScope&) = delete;
  ClockScope& operator=(const ClockScope&) = delete;

 private:
  SearchClock before_;
};

}  // namespace internal
}  // namespace hypotrack
