#include "interrupt.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>

#include "plugin/running_plugin.hpp"

namespace hypotrack::app {
namespace {

constexpr unsigned kSilence_s = 3;
constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

// Searching threads read the flag while the handler writes it, in whichever thread has the signal.
std::atomic<bool> g_interrupted = false;
std::atomic<unsigned> g_patience_s = 0;
std::atomic<bool> g_said_that_it_waits = false;
bool g_in_background = false;  // SIGINT was ignored when the guard began
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<unsigned>::is_always_lock_free,
              "a signal handler may not wait for a lock");

void on_signal(int signal) {
  g_interrupted = true;
  // A closed terminal may send SIGHUP twice, from its shell and the kernel: keep ignoring it.
  if (signal != SIGHUP) std::signal(signal, SIG_DFL);
  alarm(std::min(kSilence_s, g_patience_s.load()));
}

/// Handles SIGINT of a program that was started with SIGINT ignored, as shells without job control
/// start those in the background: Ctrl-C, which the kernel sends to all programs of a terminal, is
/// for others. Who sends the signal to this program means it.
void on_interrupt_in_background(int signal, siginfo_t* info, void* /*unused*/) {
  if (info->si_code != SI_KERNEL) on_signal(signal);
}

/// Sets the handler of a signal; one that was ignored stays so.
void handle(int signal) {
  if (std::signal(signal, on_signal) != SIG_IGN) return;
  std::signal(signal, SIG_IGN);
  if (signal != SIGINT) return;
  struct sigaction wanted {};
  wanted.sa_sigaction = on_interrupt_in_background;
  wanted.sa_flags = SA_SIGINFO | SA_RESTART;
  g_in_background = sigaction(SIGINT, &wanted, nullptr) == 0;
}

/// Undoes handle().
void stop_handling(int signal) {
  const bool ignored = std::signal(signal, SIG_DFL) == SIG_IGN;
  if (ignored || (signal == SIGINT && g_in_background)) std::signal(signal, SIG_IGN);
}

void on_alarm(int /*signal*/) {
  if (!g_said_that_it_waits.exchange(true) && g_patience_s > kSilence_s) {
    detail::report_end("was told to stop and has not answered yet. Ctrl-C again ends it at once");
    alarm(g_patience_s - kSilence_s);
    return;
  }
  detail::report_end("was told to stop and did not answer; ended now. Files are left unfinished");
  _exit(kInterruptedExitCode);
}

}  // namespace

InterruptGuard::InterruptGuard(unsigned patience_s) {
  g_interrupted = g_said_that_it_waits = false;
  g_patience_s = patience_s;
  of_alarm_ = std::signal(SIGALRM, on_alarm);
  g_in_background = false;
  // nohup ignores a closed terminal: keep it ignored then.
  for (const int signal : kSignals) handle(signal);
  // Ctrl-C also ends the reader of `| tee log`, before the files are finished.
  of_broken_pipe_ = std::signal(SIGPIPE, SIG_IGN);
}

InterruptGuard::~InterruptGuard() {
  alarm(0);
  std::signal(SIGALRM, of_alarm_);
  std::signal(SIGPIPE, of_broken_pipe_);
  for (const int signal : kSignals) stop_handling(signal);
}

bool InterruptGuard::signalled() { return g_interrupted; }

bool InterruptGuard::interrupted() const {
  if (!signalled()) return false;
  alarm(0);  // somebody acts on it
  return true;
}

}  // namespace hypotrack::app
