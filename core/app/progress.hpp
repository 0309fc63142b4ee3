#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace hypotrack::app {

/// Progress on stderr: a bar with the speed and the time left on a terminal, a plain line every few
/// seconds otherwise.
class Progress {
 public:
  enum class Unit { frames, runs };

  /// `total` is the number of frames or runs, where it is known.
  explicit Progress(std::optional<int> total, Unit unit = Unit::frames);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One more frame or run is done; `note` is shown behind the numbers.
  void advance(const std::string& note);

  /// A line of its own, clear of the bar.
  void say(const std::string& text);

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
