#include "plugin/crash_report.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <cstdio>

#include "plugin/running_plugin.hpp"

namespace hypotrack::detail::internal {
namespace {

std::atomic<bool> g_exit_is_early = false;

void on_crash(int signal) {
  report_end("crashed");
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void on_early_exit(int code, void* /*unused*/) {
  if (!g_exit_is_early) return;
  report_end("ended the program by exit() before its work was done");
  std::fflush(stdout);
  _exit(code == 0 ? EXIT_FAILURE : code);
}

}  // namespace

CrashReport::CrashReport() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction now {};
    sigaction(kSignals[i], nullptr, &now);
    if (now.sa_handler != SIG_DFL) continue;
    struct sigaction own {};
    own.sa_handler = on_crash;
    own.sa_flags = SA_ONSTACK;  // the plugin's may be full
    taken_[i] = sigaction(kSignals[i], &own, nullptr) == 0;
  }
}

CrashReport::~CrashReport() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction now {};
    sigaction(kSignals[i], nullptr, &now);
    // Keep a handler that a library has installed.
    if (taken_[i] && now.sa_handler == on_crash) std::signal(kSignals[i], SIG_DFL);
  }
}

EarlyExitReport::EarlyExitReport() {
  g_exit_is_early = true;
  on_exit(on_early_exit, nullptr);
}

EarlyExitReport::~EarlyExitReport() { g_exit_is_early = false; }

}  // namespace hypotrack::detail::internal
