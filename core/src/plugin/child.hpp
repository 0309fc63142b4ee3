#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace hypotrack::detail {

/// The exit of a child process and what it wrote to its descriptor 3.
struct ChildResult {
  std::vector<std::string> lines;  ///< complete lines
  bool timed_out = false;          ///< it was killed at the time limit
  int signal = 0;                  ///< signal that ended it, 0 = none
  int exit_code = 0;
};

/// Runs a program with one argument until it ends or `limit` passes. Its standard streams are
/// closed. Safe in a process with threads. Throws PluginError if the program cannot start.
ChildResult run_child(const std::filesystem::path& program, const std::string& argument,
                      std::chrono::milliseconds limit);

}  // namespace hypotrack::detail
