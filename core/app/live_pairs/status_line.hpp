#pragma once

#include <chrono>
#include <string>

namespace hypotrack::app {

/// Shows on stderr what goes on: on a terminal one line that changes, otherwise a new line at most
/// once in a period.
class StatusLine {
 public:
  explicit StatusLine(std::chrono::seconds period = std::chrono::seconds(1));
  /// Ends the line.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void show(const std::string& text);
  /// Prints a line that stays; on a terminal with a sound if `ring`.
  void say(const std::string& text, bool ring = false);

 private:
  bool terminal_;
  std::string shown_;
  std::chrono::seconds period_;
  std::chrono::steady_clock::time_point shown_at_;
};

}  // namespace hypotrack::app
