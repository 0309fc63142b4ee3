#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <optional>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "track/search/candidate_finder.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Searches one frame in another thread while later frames go by.
class BackgroundSearch {
 public:
  using Search = std::function<Candidate(const Frame&)>;

  /// Lets a search use so many threads.
  explicit BackgroundSearch(int threads) : arena_(threads) {}
  ~BackgroundSearch() { cancel(); }
  BackgroundSearch(const BackgroundSearch&) = delete;
  BackgroundSearch& operator=(const BackgroundSearch&) = delete;

  /// Returns whether a search was begun whose result was not taken. Until then nothing else may use
  /// what it uses.
  bool is_running() const { return job_.valid(); }
  /// Begins a search of a copy of the frame. Precondition: !is_running().
  void start(const Frame& frame, Search search);
  /// Returns the result of the search, or nothing while it goes on. Throws what the search threw.
  /// Precondition: is_running().
  std::optional<Candidate> take();
  /// Ends a search by check_stop() and drops its result.
  void cancel();

 private:
  oneapi::tbb::task_arena arena_;
  std::atomic<bool> unwanted_ = false;
  std::future<Candidate> job_;
};

}  // namespace internal
}  // namespace hypotrack
