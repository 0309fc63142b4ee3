#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hypotrack::study {

/// A program to start.
struct Command {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path directory;  ///< working directory
  std::filesystem::path log;        ///< file for its stdout and stderr
  int threads = 1;                  ///< for programs that take it from the environment (Mesa)
  int inherit = -1;                 ///< file descriptor that stays open in it
};

/// The end of a program.
struct Ended {
  std::size_t key = 0;  ///< key given to start()
  int exit_code = 0;
  int signal = 0;  ///< signal that ended it; 0: none
  double seconds = 0;
};

/// Programs that run at the same time. None outlives the pool, nor this process: the kernel kills
/// them with it. They do not get the terminal's Ctrl-C.
class ProcessPool {
 public:
  ProcessPool() = default;
  ~ProcessPool();
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  /// Starts a program. Throws OutputError if no process can be made or the log cannot be written. A
  /// program that cannot be run ends with exit code 126.
  void start(std::size_t key, const Command& command);
  /// Removes and returns a program that has ended, if any.
  std::optional<Ended> take_ended();
  void kill_all();
  std::size_t size() const { return running_.size(); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Running {
    std::size_t key;
    pid_t pid;
    Clock::time_point begin;
  };
  std::vector<Running> running_;
};

}  // namespace hypotrack::study
