#include "live_pairs/status_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include "tell.hpp"

namespace hypotrack::app {
namespace {

/// Returns as much of a text as fits into a line of the terminal.
std::string fitting(const std::string& text) {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return text.substr(0, known ? size.ws_col - 1U : text.size());
}

}  // namespace

StatusLine::StatusLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

StatusLine::~StatusLine() {
  if (terminal_ && !shown_.empty()) tell("\r\x1b[K");
}

void StatusLine::show(const std::string& text) {
  constexpr std::chrono::seconds kPeriod{1};
  const auto now = std::chrono::steady_clock::now();
  if (text == shown_ || (!terminal_ && now - shown_at_ < kPeriod)) return;
  shown_ = text;
  shown_at_ = now;
  if (terminal_)
    tell("\r{}\x1b[K", fitting(text));
  else
    tell("{}\n", text);
}

void StatusLine::say(const std::string& text, bool ring) {
  tell("{}{}{}\n", terminal_ ? "\r\x1b[K" : "", text, terminal_ && ring ? "\a" : "");
  shown_.clear();
}

}  // namespace hypotrack::app
