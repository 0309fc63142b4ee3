#include "block.hpp"

#include <alloca.h>
#include <sys/mman.h>

#include <algorithm>
#include <iterator>
#include <new>
#include <string>
#include <utility>

#include "blocks.hpp"

namespace cuda_on_cpu {
namespace {

constexpr std::size_t kStack = 128 << 10;
constexpr std::size_t kColour = 320;
/// A warp goes on before all others for so many exchanges: its stacks are in the cache.
constexpr unsigned kExchangesAtOnce = 64;

/// Ends a thread of a kernel that has failed.
struct Stopped {};

}  // namespace

struct BlockRunner::Thread {
  ThreadPlace place;
  int number = 0;
  Thread* next = nullptr;  ///< in its queue
  void* race_checker = nullptr;
  boost::context::fiber fiber;   ///< while it waits
  boost::context::fiber runner;  ///< while it runs
};

struct BlockRunner::Warp {
  Queue waiting;
  std::uint64_t numbers[2][kWarp] = {};  ///< of exchanges that take turns
  std::uint32_t there[2] = {};
  const void* heard[2][kWarp] = {};  ///< slots that lanes have read before an exchange
  unsigned exchanges = 0;
  int live = 0;
  Kind kind = Kind::none;
  Meeting met;
};

Stacks::Stacks()
    : memory_(mmap(nullptr, kMostThreadsOfBlock * kStack, PROT_READ | PROT_WRITE,
                   MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)) {
  if (memory_ == MAP_FAILED) throw std::bad_alloc();
}
Stacks::~Stacks() { munmap(memory_, kMostThreadsOfBlock * kStack); }

boost::context::preallocated Stacks::stack(std::size_t number) const {
  boost::context::stack_context stack;
  stack.size = kStack;
  stack.sp = static_cast<char*>(memory_) + (number + 1) * kStack;
  return {stack.sp, stack.size, stack};
}

void BlockRunner::Queue::push(Thread& thread) {
  thread.next = nullptr;
  (first ? last->next : first) = &thread;
  last = &thread;
  ++size;
}

BlockRunner::Thread& BlockRunner::Queue::pop() {
  Thread& thread = *first;
  first = thread.next;
  --size;
  return thread;
}

void BlockRunner::Queue::append(Queue& others) {
  others.prepend(*this);
  *this = std::exchange(others, {});
}

void BlockRunner::Queue::prepend(Queue& others) {
  if (!others.first) return;
  others.last->next = first;
  if (!first) last = others.last;
  first = others.first;
  size += std::exchange(others, {}).size;
}

BlockRunner::BlockRunner(const ThreadPlace*& here) : here_(here), own_fiber_(current_fiber()) {}
BlockRunner::~BlockRunner() = default;

void BlockRunner::prepare(int threads) {
  while (static_cast<int>(threads_.size()) < threads) {
    auto thread = std::make_unique<Thread>();
    thread->number = static_cast<int>(threads_.size());
    thread->race_checker = new_fiber();
    thread->fiber = boost::context::fiber(
        std::allocator_arg, stacks_.stack(threads_.size()), KeepStack(),
        [this, own = thread.get()](boost::context::fiber&& runner) -> boost::context::fiber {
          own->runner = std::move(runner);
          // Stacks that begin at the same place of a page would all have the same lines of a cache.
          *static_cast<volatile char*>(alloca(kColour * (own->number % kWarp + 1))) = 0;
          for (;;) {
            acquire(&begin_);
            try {
              (*kernel_)();
            } catch (const Stopped&) {
            }
            release(&end_);
            end_thread();
            wait();
          }
        });
    threads_.push_back(std::move(thread));
  }
  warps_.resize(static_cast<std::size_t>((threads + kWarp - 1) / kWarp));
}

void BlockRunner::run(const ThreadPlace& block, const std::function<void()>& thread) {
  const uint3 size = block.block_size;
  const int count = static_cast<int>(size.x * size.y * size.z);
  kernel_ = &thread;
  prepare(count);
  failure_.clear();
  ready_ = meeting_ = {};
  live_ = count;
  count_ = 0;
  for (Warp& warp : warps_) {
    warp.waiting = {};
    warp.kind = Kind::none;
    warp.live = 0;
    for (auto& turn : warp.heard) std::fill(std::begin(turn), std::end(turn), nullptr);
  }
  for (int i = 0; i < count; ++i) {
    Thread& t = *threads_[static_cast<std::size_t>(i)];
    const auto n = static_cast<unsigned>(i);
    t.place = block;
    t.place.thread = {n % size.x, n / size.x % size.y, n / (size.x * size.y)};
    t.place.lane = i % kWarp;
    ++warps_[static_cast<std::size_t>(i / kWarp)].live;
    ready_.push(t);
  }
  release(&begin_);
  while (live_ > 0) {
    if (ready_.size == 0) {
      note_failure("threads wait for others that do not come", waiting_thread());
      wake_all();
    }
    resume(ready_.pop());
  }
  acquire(&end_);
  if (!failure_.empty()) throw KernelError(failure_);
}

void BlockRunner::resume(Thread& thread) {
  running_ = &thread;
  here_ = &thread.place;
  change_to(thread.race_checker);
  thread.fiber = std::move(thread.fiber).resume();
  running_ = nullptr;
}

void BlockRunner::wait() {
  Thread& own = *running_;
  change_to(own_fiber_);
  own.runner = std::move(own.runner).resume();
}

void BlockRunner::wake_all() {
  for (Warp& warp : warps_) ready_.append(warp.waiting);
  ready_.append(meeting_);
}

const BlockRunner::Thread& BlockRunner::waiting_thread() const {
  if (meeting_.first) return *meeting_.first;
  const auto warp = std::find_if(warps_.begin(), warps_.end(),
                                 [](const Warp& w) { return w.waiting.first != nullptr; });
  return *warp->waiting.first;
}

/// The first one counts.
void BlockRunner::note_failure(const std::string& why, const Thread& thread) {
  if (!failure_.empty()) return;
  const auto text = [](const uint3& at) {
    return "(" + std::to_string(at.x) + ", " + std::to_string(at.y) + ", " + std::to_string(at.z) +
           ")";
  };
  failure_ = why + ", block " + text(thread.place.block) + ", thread " + text(thread.place.thread);
}

void BlockRunner::fail(const std::string& why) {
  note_failure(why, *running_);
  wake_all();
  throw Stopped();
}

void BlockRunner::finish_meeting() {
  last_count_ = std::exchange(count_, 0);
  ++meetings_;
  ready_.append(meeting_);
}

int BlockRunner::meet_block(bool predicate) {
  const unsigned time = meetings_;
  met_.arrive(time);
  count_ += predicate ? 1 : 0;
  if (meeting_.size + 1 == live_) {
    finish_meeting();
  } else {
    meeting_.push(*running_);
    wait();
    if (!failure_.empty()) throw Stopped();
  }
  met_.leave(time);
  return last_count_;
}

void BlockRunner::finish_exchange(Warp& warp) {
  warp.kind = Kind::none;
  ++warp.exchanges;
  warp.there[warp.exchanges % 2] = 0;
  for (const void*& slot : warp.heard[warp.exchanges % 2]) slot = nullptr;
  if (warp.exchanges % kExchangesAtOnce != 0) {
    ready_.prepend(warp.waiting);
  } else {
    ready_.append(warp.waiting);
  }
}

BlockRunner::Exchanged BlockRunner::exchange(unsigned mask, Kind kind, std::uint64_t number) {
  if (mask != 0xFFFFFFFFu) fail("threads of a part of a warp are not told apart here");
  Warp& warp = warps_[static_cast<std::size_t>(running_->number / kWarp)];
  if (warp.kind == Kind::none) warp.kind = kind;
  if (warp.kind != kind) fail("the threads of a warp do not do the same together");
  const unsigned turn = warp.exchanges % 2;
  const auto lane = static_cast<unsigned>(running_->place.lane);
  warp.numbers[turn][lane] = number;
  warp.there[turn] |= 1u << lane;
  if (warp.waiting.size + 1 == warp.live) {
    finish_exchange(warp);
  } else {
    warp.waiting.push(*running_);
    wait();
    if (!failure_.empty()) throw Stopped();
  }
  for (const void* slot : warp.heard[turn]) {
    if (slot) acquire(slot);
  }
  return {warp.numbers[turn], warp.there[turn]};
}

void BlockRunner::heard(const void* slot) {
  acquire(slot);
  Warp& warp = warps_[static_cast<std::size_t>(running_->number / kWarp)];
  warp.heard[warp.exchanges % 2][running_->place.lane] = slot;
}

void BlockRunner::meet_warp() {
  Warp& warp = warps_[static_cast<std::size_t>(running_->number / kWarp)];
  const unsigned time = warp.exchanges;
  warp.met.arrive(time);
  exchange(0xFFFFFFFFu, Kind::meet, 0);
  warp.met.leave(time);
}

void BlockRunner::end_thread() {
  Warp& warp = warps_[static_cast<std::size_t>(running_->number / kWarp)];
  --live_;
  --warp.live;
  // Whoever waited for this one only goes on.
  if (warp.waiting.size > 0 && warp.waiting.size == warp.live) finish_exchange(warp);
  if (meeting_.size > 0 && meeting_.size == live_) finish_meeting();
}

}  // namespace cuda_on_cpu
