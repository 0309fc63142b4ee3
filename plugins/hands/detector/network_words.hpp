#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

// The words of the text that a network's file begins with.
namespace hypotrack::hands {

/// What is wrong with a line.
struct Damage : std::runtime_error {
  using runtime_error::runtime_error;
};

/// Returns a word of the file for a message.
std::string shown(std::string_view word);

/// The words of a line, taken one by one.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  bool empty() const { return rest_.empty(); }
  /// Returns the next word. Throws Damage if there is none.
  std::string_view take();
  /// Returns the next word as a number. Throws Damage if it is none from `low` to `high`.
  int take_number(int low, int high);

 private:
  std::string_view rest_;
};

}  // namespace hypotrack::hands
