#pragma once

#include <array>
#include <csignal>
#include <filesystem>

namespace hypotrack::detail {

/// While it lives, a crash names the library that is being opened before it ends the program as
/// ever: code of a plugin runs before anything of it can be checked.
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
