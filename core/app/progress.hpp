#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace hypotrack::app {

/// Progress on stderr: a bar with frames per second and time left on a terminal, a plain line every
/// few seconds otherwise.
class Progress {
 public:
  /// `total` is the number of frames, where it is known.
  explicit Progress(std::optional<int> total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One more frame is done; `note` is shown behind the numbers.
  void advance(const std::string& note);

  /// A line of its own, clear of the bar.
  void say(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  std::string line(const std::string& note) const;
  std::optional<int> total_;
  bool terminal_;
  int done_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point shown_{};
  std::string last_note_;
};

}  // namespace hypotrack::app
