#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace hypotrack::detail {

/// How a child process ended and what it wrote to its descriptor 3.
struct ChildResult {
  std::vector<std::string> lines;  ///< complete ones
  bool timed_out = false;          ///< it was killed
  int signal = 0;                  ///< that ended it, 0 if none did
  int exit_code = 0;
};

/// Runs a program with one argument until it ends, or until `limit` is over. Its standard streams
/// are closed off. Safe in a process with many threads. Throws PluginError if it cannot be started.
ChildResult run_child(const std::filesystem::path& program, const std::string& argument,
                      std::chrono::milliseconds limit);

}  // namespace hypotrack::detail
