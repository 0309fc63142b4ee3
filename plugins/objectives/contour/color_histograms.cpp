#include "color_histograms.hpp"

namespace hypotrack::contour {
namespace {

// Share of a colour that was never seen. One pixel of about 2,000 then weighs little against none.
constexpr float kUnseen = 5e-4f;

}  // namespace

void ColorHistograms::Side::mix(float weight) {
  const float scale = weight / static_cast<float>(sum);
  shares = (1 - weight) * shares + scale * counts.cast<float>();
}

void ColorHistograms::learn(double weight) {
  if (on_.sum > 0 && beside_.sum > 0) {
    const auto part = is_empty() ? 1.0f : static_cast<float>(weight);
    on_.mix(part);
    beside_.mix(part);
    log_odds_ = ((on_.shares + kUnseen) / (beside_.shares + kUnseen)).log();
  }
  discard();
}

void ColorHistograms::discard() {
  for (Side* side : {&on_, &beside_}) {
    side->counts.setZero();
    side->sum = 0;
  }
}

}  // namespace hypotrack::contour
