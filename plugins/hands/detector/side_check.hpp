#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

namespace hypotrack::hands {

/// Tells that a model is of the wrong side: where it is, a hand of the other side is seen in many
/// frames in a row.
class SideCheck {
 public:
  /// `enough`: frames that make it sure; single ones are mistaken, mostly those of fists.
  explicit SideCheck(int enough) : enough_(enough) {}

  /// Ends the check: a hand of the model's side was seen.
  void settle() { told_ = true; }
  /// Counts a frame, once. Returns true in the frame that makes it sure, and never again.
  bool add(int frame, bool shows_other_side) {
    if (frame == last_) return false;
    last_ = frame;
    in_a_row_ = shows_other_side ? in_a_row_ + 1 : 0;
    if (told_ || in_a_row_ < enough_) return false;
    told_ = true;
    return true;
  }

 private:
  int enough_;
  std::optional<int> last_;
  int in_a_row_ = 0;
  bool told_ = false;
};

/// Returns a warning that a right or left model is of the wrong side. `is_there`: a hand of the
/// other side is where the model is; otherwise all hands in the pictures are of that side.
inline std::string wrong_side_text(const std::string& model, bool right, bool is_there) {
  const std::string own = right ? "right" : "left", other = right ? "left" : "right";
  const std::string sight =
      is_there ? fmt::format("a {} hand where '{}' is, a {} one", other, model, own)
               : fmt::format("{} hands only, but '{}' is a {} one", other, model, own);
  return fmt::format(
      "the detector sees {}. Is the model that of the other hand (such as `type: {}`), or are the "
      "pictures mirrored?",
      sight, right ? "mirrored_hand" : "hand");
}

}  // namespace hypotrack::hands
