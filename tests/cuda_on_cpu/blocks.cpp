#include "blocks.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "block.hpp"
#include "race_checks.hpp"

namespace cuda_on_cpu {
namespace {

/// Threads of the CPU that work on the blocks of one kernel at a time.
class Workers {
 public:
  void run(dim3 grid, dim3 block, bool at_once, const std::function<void()>& thread) {
    const std::lock_guard<std::mutex> one_kernel(kernels_);
    std::unique_lock<std::mutex> lock(mutex_);
    grid_ = grid;
    block_ = block;
    thread_ = &thread;
    next_ = 0;
    failed_ = false;
    failure_ = nullptr;
    const unsigned few = std::clamp(std::thread::hardware_concurrency(), 2u,
                                    static_cast<unsigned>(multiprocessors()));
    wanted_ = at_once ? blocks() : std::min(blocks(), few);
    for (; workers_ < wanted_; ++workers_) {
      std::thread([this, own = workers_, seen = kernel_] { work(own, seen); }).detach();
    }
    working_ = wanted_;
    ++kernel_;
    begun_.notify_all();
    ended_.wait(lock, [&] { return working_ == 0; });
    if (failure_) std::rethrow_exception(failure_);
  }
  bool failed() const { return failed_; }

 private:
  unsigned blocks() const { return grid_.x * grid_.y * grid_.z; }

  void work(unsigned own, unsigned long seen) {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      begun_.wait(lock, [&] { return kernel_ != seen && own < wanted_; });
      seen = kernel_;
      lock.unlock();
      for (unsigned i = next_++; i < blocks() && !failed_; i = next_++) run_one(i);
      lock.lock();
      if (--working_ == 0) ended_.notify_one();
    }
  }

  void run_one(unsigned i) {
    ThreadPlace place{};
    place.block = {i % grid_.x, i / grid_.x % grid_.y, i / (grid_.x * grid_.y)};
    place.block_size = {block_.x, block_.y, block_.z};
    place.grid_size = {grid_.x, grid_.y, grid_.z};
    try {
      run_block(place, *thread_);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!failed_) failure_ = std::current_exception();
      failed_ = true;
    }
  }

  std::mutex kernels_, mutex_;
  std::condition_variable begun_, ended_;
  unsigned workers_ = 0;  ///< they end with the process
  unsigned wanted_ = 0, working_ = 0;
  dim3 grid_, block_;
  const std::function<void()>* thread_ = nullptr;
  std::atomic<unsigned> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::exception_ptr failure_;
  unsigned long kernel_ = 0;
};

Workers& workers() {
  static auto* const all = new Workers;  // its threads never end
  return *all;
}

}  // namespace

int multiprocessors() { return checks_races() ? 7 : 132; }

void run_blocks(dim3 grid, dim3 block, bool at_once, const std::function<void()>& thread) {
  workers().run(grid, block, at_once, thread);
}
bool kernel_has_failed() { return workers().failed(); }

}  // namespace cuda_on_cpu
