#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "messages.hpp"

namespace hypotrack::app {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr std::chrono::seconds kLinePeriod{5};

std::string duration(double seconds) {
  const auto s = static_cast<long>(seconds + 0.5);
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

Progress::Progress(std::optional<int> total, Unit unit)
    : total_(total), unit_(unit), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (done_ == 0 || (!terminal_ && shown_done_ == done_)) return;
  tell("{}{}{}\n", terminal_ ? "\r" : "", line(last_note_), terminal_ ? "\x1b[K" : "");
}

std::string Progress::speed(double per_second) const {
  if (unit_ == Unit::frames) return fmt::format("frames, {:.1f} fps", per_second);
  return fmt::format("runs, {:.1f} per minute", 60 * per_second);
}

std::string Progress::line(const std::string& note) const {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  const double per_second = elapsed > 0 ? done_ / elapsed : 0;
  std::string text;
  if (total_ && *total_ > 0) {
    if (terminal_) {
      const int filled = std::clamp(kBarWidth * done_ / *total_, 0, kBarWidth);
      text = "[" + std::string(static_cast<std::size_t>(filled), '#') +
             std::string(static_cast<std::size_t>(kBarWidth - filled), '.') + "] ";
    }
    text += fmt::format("{}/{} {}", done_, *total_, speed(per_second));
    if (done_ < *total_ && per_second > 0)
      text += ", " + duration((*total_ - done_) / per_second) + " left";
  } else {
    text = fmt::format("{} {}", done_, speed(per_second));
  }
  return note.empty() ? text : text + ", " + note;
}

void Progress::say(const std::string& text) {
  tell("{}{}\n", terminal_ ? "\r\x1b[K" : "", text);
  shown_ = {};  // shows the bar again at the next step
}

void Progress::print(const std::string& lines) {
  if (terminal_) tell("\r\x1b[K");
  std::fputs(lines.c_str(), stdout);
  std::fflush(stdout);  // main() reports a failure
  shown_ = {};
}

bool Progress::shows(const std::string& line) {
  const std::size_t end = line.find_first_not_of("0123456789/");
  return end != 0 && end != std::string::npos && line.substr(end).starts_with(" frames, ") &&
         line.find(" fps") != std::string::npos;
}

void Progress::advance(const std::string& note) {
  ++done_;
  last_note_ = note;
  const auto now = Clock::now();
  const bool due = terminal_ ? now - shown_ > kTerminalPeriod
                             : (now - shown_ > kLinePeriod && now - begin_ > kLinePeriod);
  if (!due) return;
  shown_ = now;
  shown_done_ = done_;
  if (terminal_)
    tell("\r{}\x1b[K", line(note));
  else
    tell("{}\n", line(note));
  std::fflush(stderr);
}

}  // namespace hypotrack::app
