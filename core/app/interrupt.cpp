#include "interrupt.hpp"

#include <array>
#include <csignal>

namespace hypotrack::app {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t g_interrupted = 0;

void on_signal(int signal) {
  g_interrupted = 1;
  // A closed terminal may send SIGHUP twice, from its shell and the kernel: keep ignoring it.
  if (signal != SIGHUP) std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  g_interrupted = 0;
  // A shell's background jobs and nohup ignore Ctrl-C: keep it ignored then.
  for (const int signal : kSignals)
    if (std::signal(signal, on_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  // Ctrl-C also ends the reader of `| tee log`, before the files are finished.
  of_broken_pipe_ = std::signal(SIGPIPE, SIG_IGN);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGPIPE, of_broken_pipe_);
  for (const int signal : kSignals)
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

bool InterruptGuard::interrupted() const { return g_interrupted != 0; }

}  // namespace hypotrack::app
