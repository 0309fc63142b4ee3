#include "live_pairs/status_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include "messages.hpp"

namespace hypotrack::app {
namespace {

/// Returns as much of a text as fits into a line of the terminal.
std::string fitting(const std::string& text) {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return text.substr(0, known ? size.ws_col - 1U : text.size());
}

}  // namespace

// A first line may come after a second, like one that followed another.
StatusLine::StatusLine(std::chrono::seconds period)
    : terminal_(isatty(STDERR_FILENO) == 1),
      period_(period),
      shown_at_(std::chrono::steady_clock::now() - std::chrono::seconds(1)) {}

StatusLine::~StatusLine() {
  if (terminal_ && !shown_.empty()) tell("\r\x1b[K");
}

void StatusLine::show(const std::string& text) {
  const auto now = std::chrono::steady_clock::now();
  if (text == shown_ || (!terminal_ && now - shown_at_ < period_)) return;
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
