#pragma once

namespace hypotrack::app {

/// Exit code of a run that Ctrl-C ended early, as in shells.
inline constexpr int kInterruptedExitCode = 130;

/// Makes Ctrl-C, SIGTERM and SIGHUP (a closed terminal) set a flag instead of ending the program
/// while it lives. So a frame can be finished and files closed. A second Ctrl-C or SIGTERM ends the
/// program at once. Ignores SIGPIPE: output into a closed pipe is lost.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  bool interrupted() const;

 private:
  void (*of_broken_pipe_)(int);  ///< handler of SIGPIPE before
};

}  // namespace hypotrack::app
