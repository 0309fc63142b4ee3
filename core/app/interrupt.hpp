#pragma once

namespace hypotrack::app {

/// Exit code of a run that Ctrl-C ended early, as shells have it.
inline constexpr int kInterruptedExitCode = 130;

/// While it lives, Ctrl-C, SIGTERM and SIGHUP (a closed terminal) set a flag instead of ending the
/// program, so that a frame can be finished and the files be closed. A second Ctrl-C ends the
/// program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  bool interrupted() const;
};

}  // namespace hypotrack::app
