#pragma once

#include <array>
#include <csignal>

#include "base/exported.hpp"

namespace hypotrack::detail {
inline namespace HYPOTRACK_EXPORTED internal {

/// Says which plugin ran (RunningPlugin) if the program crashes during this object's lifetime. The
/// crash then ends the program as usual. Signals that something else handles are left alone.
class CrashReport {
 public:
  CrashReport();
  ~CrashReport();
  CrashReport(const CrashReport&) = delete;
  CrashReport& operator=(const CrashReport&) = delete;

 private:
  static constexpr std::array kSignals = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};
  std::array<bool, kSignals.size()> taken_{};
};

/// Makes exit() by a plugin or library during this object's lifetime a failure: says which plugin
/// ran, and ends the program with a code that is not 0. For the whole of a main().
class EarlyExitReport {
 public:
  EarlyExitReport();
  ~EarlyExitReport();
  EarlyExitReport(const EarlyExitReport&) = delete;
  EarlyExitReport& operator=(const EarlyExitReport&) = delete;
};

}  // namespace internal
}  // namespace hypotrack::detail
