#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hypotrack::contract {

/// Thrown by a check that found a contract broken: what was found, what was expected.
class Violation : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void require(bool holds, const std::string& message) {
  if (!holds) throw Violation(message);
}

/// Thrown by a check that does not apply to this plugin, with the reason.
class Skipped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Prints one row per contract. Prints the name before the check runs, so that a plugin that
/// crashes or hangs shows where.
class Report {
 public:
  using Check = std::function<void()>;

  /// Runs a check and prints its row. It passes by returning, fails by throwing anything, and is
  /// skipped by throwing Skipped.
  void row(std::string_view name, const Check& check);
  /// Prints the last line and returns the program's exit status: 0 if no row failed.
  int finish() const;
  /// Returns whether the last row passed.
  bool passed() const { return last_passed_; }

 private:
  int passed_ = 0;
  int failed_ = 0;
  int skipped_ = 0;
  bool last_passed_ = false;
};

}  // namespace hypotrack::contract
