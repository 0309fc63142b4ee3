#pragma once

#include <optional>

namespace hypotrack::landmarks {

/// Tells that a model is of the wrong side: where it is, a hand of the other side is seen in many
/// frames in a row.
class SideCheck {
 public:
  /// Counts a frame, once. Returns true in the frame that makes it sure, and never again.
  bool add(int frame, bool shows_other_side) {
    constexpr int kEnough = 8;  // frames: single ones are mistaken, mostly those of fists
    if (frame == last_) return false;
    last_ = frame;
    in_a_row_ = shows_other_side ? in_a_row_ + 1 : 0;
    if (told_ || in_a_row_ < kEnough) return false;
    told_ = true;
    return true;
  }

 private:
  std::optional<int> last_;
  int in_a_row_ = 0;
  bool told_ = false;
};

}  // namespace hypotrack::landmarks
