#pragma once

#include <array>
#include <csignal>
#include <filesystem>

namespace hypotrack::detail {

/// Names the library being opened if the program crashes during this object's lifetime. A plugin's
/// code runs before anything about it can be checked. The crash then ends the program as usual.
class CrashNote {
 public:
  explicit CrashNote(const std::filesystem::path& library);
  ~CrashNote();
  CrashNote(const CrashNote&) = delete;
  CrashNote& operator=(const CrashNote&) = delete;

 private:
  static constexpr std::array kSignals = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace hypotrack::detail
