#pragma once

#include "hypotrack/search.hpp"

namespace hypotrack {

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

}  // namespace hypotrack
