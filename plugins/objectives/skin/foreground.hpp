#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "color_model.hpp"
#include "hypotrack/observation.hpp"
#include "hypotrack/view_pixels.hpp"
#include "settings.hpp"

namespace hypotrack::skin {

/// What tells foreground in a view.
enum class Rule { none, color, mask, depth };

/// The rule for a view; `none` where it lacks what the rule needs.
Rule rule_of(Foreground foreground, bool has_color, bool has_mask, bool has_depth);

/// How likely each pixel of one view is foreground.
struct ViewForeground {
  /// P (low) and 1 - P (high) as 16-bit fractions; both 0 where the pixel is invalid.
  PixelPlane<std::uint32_t> pixels;
  double sum = 0;  ///< of P: what a hypothesis costs that covers nothing
};

/// Tells foreground in one view, frame after frame.
class ForegroundTeller {
 public:
  explicit ForegroundTeller(const Settings& settings) : settings_(settings) {}

  /// With the colour rule, the first settings.learn_frames frames are learned from: the colours
  /// inside the silhouette of the scene as it is posed in observation.start, against those outside,
  /// give or take settings.pose_error (ColorModel::add()). The same frame again (observation.frame)
  /// teaches nothing new.
  ViewForeground tell(const Observation& observation, std::size_t view);

 private:
  void learn(const Observation& observation, const TileView& view);

  Settings settings_;
  ColorModel colors_;
  std::vector<float> probabilities_;
  std::optional<int> last_learned_;
  int learned_ = 0;
};

}  // namespace hypotrack::skin
