#pragma once

namespace hypotrack::app {

/// Exit code of a run that Ctrl-C ended early, as shells have it.
inline constexpr int kInterruptedExitCode = 130;

/// While it lives, Ctrl-C, SIGTERM and SIGHUP (a closed terminal) set a flag instead of ending the
/// program, so that a frame can be finished and the files be closed. A second Ctrl-C ends the
/// program at once. What is printed into a pipe that nobody reads any more is lost.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  bool interrupted() const;

 private:
  void (*of_broken_pipe_)(int);  ///< what was done on SIGPIPE before
};

}  // namespace hypotrack::app
