#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace hypotrack::app {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr std::chrono::seconds kLinePeriod{5};

std::string minutes(double seconds) {
  const int s = static_cast<int>(seconds + 0.5);
  return fmt::format("{}:{:02}", s / 60, s % 60);
}

}  // namespace

Progress::Progress(std::optional<int> total)
    : total_(total), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (done_ == 0) return;
  fmt::print(stderr, "{}{}{}\n", terminal_ ? "\r" : "", line(last_note_),
             terminal_ ? "\x1b[K" : "");
}

std::string Progress::line(const std::string& note) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double fps = elapsed > 0 ? done_ / elapsed : 0;
  std::string text;
  if (total_ && *total_ > 0) {
    if (terminal_) {
      const int filled = std::clamp(kBarWidth * done_ / *total_, 0, kBarWidth);
      text = "[" + std::string(static_cast<std::size_t>(filled), '#') +
             std::string(static_cast<std::size_t>(kBarWidth - filled), '.') + "] ";
    }
    text += fmt::format("{}/{} frames, {:.1f} fps", done_, *total_, fps);
    if (done_ < *total_ && fps > 0) text += ", " + minutes((*total_ - done_) / fps) + " left";
  } else {
    text = fmt::format("{} frames, {:.1f} fps", done_, fps);
  }
  return note.empty() ? text : text + ", " + note;
}

void Progress::say(const std::string& text) {
  fmt::print(stderr, "{}{}\n", terminal_ ? "\r\x1b[K" : "", text);
  shown_ = {};  // the next frame shows the bar again
}

void Progress::advance(const std::string& note) {
  ++done_;
  last_note_ = note;
  const auto now = Clock::now();
  const bool due = terminal_ ? now - shown_ > kTerminalPeriod
                             : (now - shown_ > kLinePeriod && now - begin_ > kLinePeriod);
  if (!due) return;
  shown_ = now;
  if (terminal_)
    fmt::print(stderr, "\r{}\x1b[K", line(note));
  else
    fmt::print(stderr, "{}\n", line(note));
  std::fflush(stderr);
}

}  // namespace hypotrack::app
