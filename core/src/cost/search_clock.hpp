#pragma once

#include "base/exported.hpp"
#include "hypotrack/plugin/search.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Makes a clock that of the searches on this thread, while it lives.
class SearchClockScope {
 public:
  explicit SearchClockScope(SearchClock clock);
  ~SearchClockScope();
  SearchClockScope(const SearchClockScope&) = delete;
  SearchClockScope& operator=(const SearchClockScope&) = delete;

 private:
  SearchClock before_;
};

}  // namespace internal
}  // namespace hypotrack
