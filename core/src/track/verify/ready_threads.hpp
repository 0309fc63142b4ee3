#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <initializer_list>
#include <thread>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Threads that wait awake for short works, such as the pieces of judging a pose: a sleeping thread
/// would begin too late. While awake they occupy cores, which must be idle otherwise.
class ReadyThreads {
 public:
  using Work = std::function<void()>;

  /// Begins so many threads, or as many as the system allows.
  explicit ReadyThreads(int count);
  ~ReadyThreads();
  ReadyThreads(const ReadyThreads&) = delete;
  ReadyThreads& operator=(const ReadyThreads&) = delete;

  /// Keeps threads awake while it lives, for run_together() of the calling thread. Null: none.
  class Awake {
   public:
    explicit Awake(ReadyThreads* threads);
    ~Awake();
    Awake(const Awake&) = delete;
    Awake& operator=(const Awake&) = delete;

   private:
    ReadyThreads* threads_;
  };

 private:
  friend void run_together(std::initializer_list<Work> works);

  static constexpr std::size_t kMostWorks = 16;

  void run(std::initializer_list<Work> works);
  /// Does a work that nobody has taken yet. Returns false if there is none.
  bool help();
  void live();

  enum class State { asleep, awake, ended };
  std::atomic<State> state_ = State::asleep;
  std::array<const Work*, kMostWorks> works_{};
  /// Of the present works, in bits from low to high: 16 for the next one to take, 16 for their
  /// number. Higher bits tell them from earlier ones.
  std::atomic<std::uint64_t> ticket_ = 0;
  std::atomic<int> left_ = 0;  ///< works that are not done
  std::atomic_flag failed_;
  std::exception_ptr failure_;  ///< of the first work that failed
  std::vector<std::jthread> threads_;
};

/// Does all works, at most 16, at the same time where threads are ready or the arena has others.
/// Throws what the first one of them threw, after all have ended.
void run_together(std::initializer_list<ReadyThreads::Work> works);

}  // namespace internal
}  // namespace hypotrack
