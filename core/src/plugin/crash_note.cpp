#include "plugin/crash_note.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace hypotrack::detail {
namespace {

// Filled in advance, because a signal handler may not allocate.
std::array<char, 4096> g_note;
std::size_t g_length = 0;

void on_crash(int signal) {
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, g_note.data(), g_length);
  std::signal(signal, SIG_DFL);
  raise(signal);
}

}  // namespace

CrashNote::CrashNote(const std::filesystem::path& library) {
  const std::string name = library.string();
  const std::string note = fmt::format(
      "hypotrack: {}: crashed while it was loaded; `hypotrack plugins check {}` says how\n", name,
      name);
  g_length = std::min(note.size(), g_note.size());
  std::copy_n(note.begin(), g_length, g_note.begin());
  struct sigaction action {};
  action.sa_handler = on_crash;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

CrashNote::~CrashNote() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction now {};
    sigaction(kSignals[i], nullptr, &now);
    // Keep a handler that the library itself has installed.
    if (now.sa_handler == on_crash) sigaction(kSignals[i], &before_[i], nullptr);
  }
}

}  // namespace hypotrack::detail
