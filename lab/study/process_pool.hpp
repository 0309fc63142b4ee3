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
  std::filesystem::path log;        ///< what it says on stdout and stderr
  int threads = 1;                  ///< for what is told so by the environment (Mesa)
  int inherit = -1;                 ///< a descriptor that stays open in it
};

/// How a program ended.
struct Ended {
  std::size_t key = 0;  ///< that it was started with
  int exit_code = 0;
  int signal = 0;  ///< that ended it; 0 if none did
  double seconds = 0;
};

/// Programs that run at the same time. None outlives the pool, nor this process: when it is killed,
/// the kernel kills them. They do not get the terminal's Ctrl-C.
class ProcessPool {
 public:
  ProcessPool() = default;
  ~ProcessPool();
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  /// Throws OutputError if no process can be made or the log cannot be written; a program that
  /// cannot be run ends with exit code 126.
  void start(std::size_t key, const Command& command);
  /// One that has ended, if any.
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
