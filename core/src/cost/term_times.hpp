#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "base/exported.hpp"

namespace hypotrack {

/// A sum of durations that several threads may add to.
class TimeSum {
 public:
  /// Returns the sum in seconds.
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_.load()); }

  /// Adds the duration of its life to a sum.
  class Scope {
   public:
    /// A null sum measures nothing.
    explicit Scope(TimeSum* sum) : sum_(sum) {}
    ~Scope() {
      if (!sum_) return;
      const auto duration = std::chrono::steady_clock::now() - begin_;
      sum_->nanoseconds_.fetch_add(
          std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count(),
          std::memory_order_relaxed);
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    TimeSum* sum_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  };

 private:
  std::atomic<std::int64_t> nanoseconds_ = 0;
};

/// How long an objective worked on the CPU, in all threads together.
struct TermTimes {
  TimeSum prepare;
  TimeSum cost;  ///< costs, residuals and their slopes
};

inline namespace HYPOTRACK_EXPORTED internal {

/// The times of a term of a scene.
struct NamedTermTimes {
  std::string name;  ///< `objective.1 (edges)`
  std::shared_ptr<const TermTimes> times;
};

}  // namespace internal
}  // namespace hypotrack
