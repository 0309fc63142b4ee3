#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace hypotrack::app {

/// Shows progress on stderr: on a terminal a bar with the speed and the time left, otherwise a
/// plain line every few seconds.
class Progress {
 public:
  enum class Unit { frames, runs };

  /// `total` is the number of frames or runs, if known.
  explicit Progress(std::optional<int> total, Unit unit = Unit::frames);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Counts one more frame or run; shows `note` after the numbers.
  void advance(const std::string& note);

  /// Prints a separate line without disturbing the bar.
  void say(const std::string& text);
  /// Prints lines to stdout without disturbing the bar.
  void print(const std::string& lines);
  /// Returns whether a line is one that a Progress of frames prints.
  static bool shows(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  std::string line(const std::string& note) const;
  std::string speed(double per_second) const;
  std::optional<int> total_;
  Unit unit_;
  bool terminal_;
  int done_ = 0;
  int shown_done_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point shown_{};
  std::string last_note_;
};

}  // namespace hypotrack::app
