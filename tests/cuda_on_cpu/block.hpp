#pragma once

#include <boost/context/fiber.hpp>
#include <boost/context/preallocated.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "cuda_on_cpu/threads.hpp"
#include "race_checks.hpp"

namespace cuda_on_cpu {

inline constexpr int kWarp = 32;

/// What a kernel did that no GPU would have gone through with.
struct KernelError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Room for the stacks of a block's threads: one piece, because a process may have only so many.
class Stacks {
 public:
  Stacks();
  ~Stacks();
  Stacks(const Stacks&) = delete;
  Stacks& operator=(const Stacks&) = delete;
  boost::context::preallocated stack(std::size_t number) const;

 private:
  void* memory_;
};

/// Gives nothing back: Stacks does.
struct KeepStack {
  void deallocate(boost::context::stack_context&) const {}
};

/// The blocks of kernels that one thread of the CPU works on, one at a time: their threads are
/// fibers, which are kept from block to block.
class BlockRunner {
 public:
  /// `here` always points to the place of the thread that runs.
  explicit BlockRunner(const ThreadPlace*& here);
  ~BlockRunner();

  /// Runs `thread` in every thread of a block; throws KernelError.
  void run(const ThreadPlace& block, const std::function<void()>& thread);

  // What follows is called by the running thread.
  int meet_block(bool predicate);
  void meet_warp();
  /// Gives a number to the warp and gets those of its lanes that have not ended; `kind` says what
  /// is done together.
  struct Exchanged {
    const std::uint64_t* numbers;
    std::uint32_t there;  ///< a bit for each lane
  };
  enum class Kind { none, meet, ballot, shuffle };
  Exchanged exchange(unsigned mask, Kind kind, std::uint64_t number);
  /// The running thread has read a slot of another block. It does what follows after that, and so
  /// does whoever hears of it through an exchange: a GPU does not load early what depends on it.
  void heard(const void* slot);
  [[noreturn]] void fail(const std::string& why);

 private:
  struct Thread;
  struct Warp;
  /// Threads that wait, or are to go on, in their order. It reserves no memory: the thread
  /// sanitizer would think that those who do had to wait for one another.
  struct Queue {
    Thread* first = nullptr;
    Thread* last = nullptr;
    int size = 0;
    void push(Thread& thread);
    Thread& pop();
    void append(Queue& others);
    void prepend(Queue& others);
  };

  void prepare(int threads);
  void resume(Thread& thread);
  void wait();
  void wake_all();
  void note_failure(const std::string& why, const Thread& thread);
  const Thread& waiting_thread() const;
  void finish_exchange(Warp& warp);
  void finish_meeting();
  void end_thread();

  Stacks stacks_;  ///< outlive the threads
  std::vector<std::unique_ptr<Thread>> threads_;
  std::vector<Warp> warps_;
  Queue ready_;
  const ThreadPlace*& here_;
  Thread* running_ = nullptr;
  const std::function<void()>* kernel_ = nullptr;
  std::string failure_;
  void* own_fiber_ = nullptr;
  char begin_ = 0, end_ = 0;  ///< of a block: events

  // Of the block.
  Queue meeting_;
  Meeting met_;
  unsigned meetings_ = 0;
  int live_ = 0, count_ = 0, last_count_ = 0;
};

}  // namespace cuda_on_cpu
