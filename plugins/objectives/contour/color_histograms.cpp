#include "color_histograms.hpp"

#include <algorithm>
#include <cmath>

namespace hypotrack::contour {
namespace {

// Share of a colour that was never seen. One pixel of about 2,000 then weighs little against none.
constexpr float kUnseen = 5e-4f;

}  // namespace

void ColorHistograms::Side::mix(float weight) {
  const float scale = weight / static_cast<float>(sum);
  for (std::size_t i = 0; i < kBins; ++i)
    shares[i] = (1 - weight) * shares[i] + scale * static_cast<float>(counts[i]);
}

void ColorHistograms::learn(double weight) {
  if (on_.sum > 0 && beside_.sum > 0) {
    const auto part = is_empty() ? 1.0f : static_cast<float>(weight);
    on_.mix(part);
    beside_.mix(part);
    log_odds_.assign(kBins, 0);
    for (std::size_t i = 0; i < kBins; ++i)
      if (on_.shares[i] + beside_.shares[i] > 0)
        log_odds_[i] = std::log((on_.shares[i] + kUnseen) / (beside_.shares[i] + kUnseen));
  }
  discard();
}

void ColorHistograms::discard() {
  for (Side* side : {&on_, &beside_}) {
    std::ranges::fill(side->counts, 0);
    side->sum = 0;
  }
}

cv::Mat1f ColorHistograms::log_odds(const cv::Mat3b& color, const cv::Mat1b& valid) const {
  cv::Mat1f out(color.size(), 0.0f);
  if (is_empty()) return out;
  for (int y = 0; y < color.rows; ++y) {
    const cv::Vec3b* from = color[y];
    const uchar* is_valid = valid[y];
    float* to = out[y];
    for (int x = 0; x < color.cols; ++x)
      if (is_valid[x] != 0) to[x] = log_odds_[bin_of(from[x])];
  }
  return out;
}

}  // namespace hypotrack::contour
