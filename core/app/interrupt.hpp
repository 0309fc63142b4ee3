#pragma once

namespace hypotrack::app {

/// Exit code of a run that Ctrl-C ended early, as in shells.
inline constexpr int kInterruptedExitCode = 130;

/// Makes Ctrl-C, SIGTERM and SIGHUP (a closed terminal) set a flag instead of ending the program
/// while it lives. So a frame can be finished and files closed. A second Ctrl-C or SIGTERM ends the
/// program at once; so does a minute in which nobody asks for the flag, as in a search that never
/// returns. Ignores SIGPIPE: output into a closed pipe is lost. Signals that were ignored stay so,
/// but for SIGINT from a program: `kill -INT` ends jobs that shells without job control started in
/// the background, and Ctrl-C does not.
class InterruptGuard {
 public:
  /// `patience_s`: seconds after a signal until the program is ended.
  explicit InterruptGuard(unsigned patience_s = 60);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  /// Returns whether a signal came; the caller acts on it, so nothing ends the program any more.
  bool interrupted() const;
  /// Returns whether a signal came. May be called from any thread.
  static bool signalled();

 private:
  void (*of_broken_pipe_)(int);  ///< handler of SIGPIPE before
  void (*of_alarm_)(int);        ///< handler of SIGALRM before
};

}  // namespace hypotrack::app
