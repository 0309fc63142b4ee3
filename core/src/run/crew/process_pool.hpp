#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "base/subprocess.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The end of a program, or of a run in one.
struct Ended {
  std::size_t key = 0;  ///< key given at the start
  Subprocess::End end;
  double seconds = 0;
  double limit_s = 0;  ///< time limit after which it was ended; 0: it ended by itself
  std::optional<int> gpu = std::nullopt;  ///< number of the GPU that a worker had for it
};

/// Programs that run at the same time. None outlives the pool.
class ProcessPool {
 public:
  /// `limit_s`: seconds after which a program is ended; 0: never.
  explicit ProcessPool(double limit_s = 0) : limit_s_(limit_s) {}
  /// Starts a program. Throws OutputError if it cannot be started or its log cannot be written.
  void start(std::size_t key, const Subprocess::Command& command);
  /// Removes and returns a program that has ended, if any.
  std::optional<Ended> take_ended();
  std::size_t size() const { return running_.size(); }
  /// Sends a signal to all programs.
  void signal(int number) const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Running {
    std::size_t key;
    Subprocess process;
    Clock::time_point begin;
  };
  double limit_s_;
  std::vector<Running> running_;
};

/// Starts a program. Throws OutputError if it cannot be started or its log cannot be written.
Subprocess start_process(const Subprocess::Command& command);

}  // namespace internal
}  // namespace hypotrack
