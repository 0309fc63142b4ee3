#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A program that runs beside this one. The kernel kills it when the thread that started it ends.
/// It leads a process group of its own, so that the terminal's Ctrl-C does not reach it. What it
/// leaves running in the group is killed at its end.
class Subprocess {
 public:
  /// A program to start. Its standard input is empty.
  struct Command {
    std::filesystem::path program;            ///< its file; PATH is not searched
    std::vector<std::string> arguments = {};  ///< without the program's name
    std::vector<std::string> variables = {};  ///< NAME=value, added to the environment
    std::filesystem::path directory = {};     ///< working directory; empty: this program's
    std::filesystem::path output = {};        ///< file for standard output; empty: dropped
    std::filesystem::path errors = {};        ///< file for standard error; empty: dropped
    /// More descriptors for it: that of this program, its number there (the same, or below 16).
    std::vector<std::pair<int, int>> descriptors = {};
  };

  /// The end of a program. Both are 0 if this program ignores SIGCHLD, which loses the status.
  struct End {
    int code = 0;    ///< exit code; 128 + signal if a signal ended it, as in shells
    int signal = 0;  ///< signal that ended it; 0: none
  };

  /// Starts a program; safe in a program with threads. Throws std::system_error, with a text that
  /// names the file, if the program cannot be started or a file cannot be written.
  explicit Subprocess(const Command& command);
  /// Kills the program if it still runs.
  ~Subprocess();
  Subprocess(Subprocess&& other) noexcept;
  Subprocess& operator=(Subprocess&& other) noexcept;

  bool running();
  /// Waits for the end.
  End wait();
  /// Waits until the end or a time. Returns whether the program has ended.
  bool wait_until(std::chrono::steady_clock::time_point time);
  /// Sends a signal to the program, but not to its child processes.
  void signal(int number) const;
  /// Kills the program and its process group, and waits for its end.
  void kill();

 private:
  /// Asks for the end with waitpid's options. Returns whether the program has ended.
  bool ended(int options);

  pid_t pid_ = -1;  ///< -1 after the end
  End end_;
};

struct CaptureLimits {
  std::optional<std::chrono::milliseconds> time = std::nullopt;
  std::size_t bytes = std::numeric_limits<std::size_t>::max();
};

/// What a program wrote, and how it ended.
struct Captured {
  std::string output;
  Subprocess::End end;
  bool timed_out = false;  ///< it was killed at the time limit
  bool too_large = false;  ///< it was killed because it wrote more than the limit
};

/// Runs a program until it ends or exceeds a limit. Collects what it writes to the descriptors of
/// some numbers, 1 for standard output. Throws as Subprocess does.
Captured capture_output(Subprocess::Command command, const std::vector<int>& numbers,
                        const CaptureLimits& limits = {});

/// Returns the name of a signal: "SIGSEGV", or "signal 40" if it has none.
std::string signal_name(int signal);

}  // namespace internal
}  // namespace hypotrack
