#pragma once

/// What tells the thread sanitizer who waits for whom, in programs that are built with it: it takes
/// every fiber for a thread.
extern "C" {
__attribute__((weak)) void* __tsan_get_current_fiber();
__attribute__((weak)) void* __tsan_create_fiber(unsigned flags);
__attribute__((weak)) void __tsan_switch_to_fiber(void* fiber, unsigned flags);
__attribute__((weak)) void __tsan_acquire(void* address);
__attribute__((weak)) void __tsan_release(void* address);
}

namespace cuda_on_cpu {

inline bool checks_races() { return __tsan_create_fiber != nullptr; }
inline void acquire(const void* event) {
  if (checks_races()) __tsan_acquire(const_cast<void*>(event));
}
inline void release(void* event) {
  if (checks_races()) __tsan_release(event);
}
inline void* current_fiber() { return checks_races() ? __tsan_get_current_fiber() : nullptr; }
inline void* new_fiber() { return checks_races() ? __tsan_create_fiber(0) : nullptr; }
/// Changing over orders nothing.
inline void change_to(void* fiber) {
  constexpr unsigned kWithoutOrder = 1;
  if (checks_races()) __tsan_switch_to_fiber(fiber, kWithoutOrder);
}

/// Many threads meet again and again: what they did before is ordered before what they do after.
/// One event would not do: who arrives for the next time must not be heard by who still leaves.
struct Meeting {
  char events[2] = {};
  void arrive(unsigned time) { release(&events[time % 2]); }
  void leave(unsigned time) { acquire(&events[time % 2]); }
};

}  // namespace cuda_on_cpu
