#include "track/verify/foreground_colors.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace hypotrack::internal {
namespace {

// Histogram bins of brightness and of the red and green chromaticity, which light changes less.
constexpr int kBright = 8, kShares = 32;
constexpr std::size_t kBins = std::size_t{kBright} * kShares * kShares;
constexpr float kFade = 0.9f;
// Count below which a colour says little: it is hardly foreground then.
constexpr float kUnseenShare = 1e-4f;

/// Histogram bin of a colour.
struct Bin {
  int bright, red, green;

  bool exists() const {
    return std::min({bright, red, green}) >= 0 && bright < kBright &&
           std::max(red, green) < kShares;
  }
  std::size_t index() const {
    return static_cast<std::size_t>((bright * kShares + red) * kShares + green);
  }
};

Bin bin_of(const cv::Vec3f& color) {
  // The chromaticity of dark colours is noise: the floor draws them to grey.
  constexpr float kFloor = 8;
  const float blue = std::max(color[0], 0.0f) + kFloor, green = std::max(color[1], 0.0f) + kFloor,
              red = std::max(color[2], 0.0f) + kFloor;
  const float sum = blue + green + red;
  // Chromaticities lie around a third; few are beyond 0.7.
  const auto share = [&](float channel) {
    return std::clamp(static_cast<int>(channel / sum * (kShares / 0.7f)), 0, kShares - 1);
  };
  const float bright = (sum - 3 * kFloor) / 3 * (kBright / 256.0f);
  return {std::clamp(static_cast<int>(bright), 0, kBright - 1), share(red), share(green)};
}

/// Adds a colour to its bin, and fractions of it to the neighbours, as noise and light would.
void add(std::vector<float>& counts, const cv::Vec3f& color) {
  constexpr float kShare = 0.3f, kLight = 0.4f;
  const Bin here = bin_of(color);
  for (int db = -1; db <= 1; ++db)
    for (int dr = -1; dr <= 1; ++dr)
      for (int dg = -1; dg <= 1; ++dg) {
        const Bin bin{here.bright + db, here.red + dr, here.green + dg};
        if (bin.exists())
          counts[bin.index()] +=
              (db == 0 ? 1 : kLight) * (dr == 0 ? 1 : kShare) * (dg == 0 ? 1 : kShare);
      }
}

float sum(const std::vector<float>& counts) {
  float total = 0;
  for (const float c : counts) total += c;
  return std::max(total, 1.0f);
}

}  // namespace

void ForegroundColors::learn(const SurfaceSamples& samples) {
  foreground_.resize(kBins);
  background_.resize(kBins);
  for (float& c : foreground_) c *= kFade;
  for (float& c : background_) c *= kFade;
  for (const SampledView& view : samples.views) {
    cv::Mat1b inner;
    cv::erode(view.inside, inner, cv::Mat());
    for (int y = 0; y < view.color.rows; ++y)
      for (int x = 0; x < view.color.cols; ++x) {
        if (inner(y, x)) add(foreground_, view.color(y, x));
        if (view.ring(y, x)) add(background_, view.color(y, x));
      }
  }
  update();
}

void ForegroundColors::expect(std::span<const cv::Vec3f> surface,
                              std::span<const cv::Mat3b> pictures) {
  foreground_.assign(kBins, 0);
  background_.assign(kBins, 0);
  for (const cv::Vec3f& color : surface)
    for (const float light : {0.35f, 0.5f, 0.7f, 0.85f, 1.0f, 1.15f})
      add(foreground_, light * color);
  for (const cv::Mat3b& picture : pictures)
    for (const cv::Vec3b& color : picture) add(background_, color);
  update();
}

void ForegroundColors::update() {
  probability_.resize(kBins);
  const float f = 1 / sum(foreground_), b = 1 / sum(background_);
  for (std::size_t i = 0; i < kBins; ++i)
    probability_[i] = (f * foreground_[i] + 0.1f * kUnseenShare) /
                      (f * foreground_[i] + b * background_[i] + kUnseenShare);
}

float ForegroundColors::probability(const cv::Vec3f& color) const {
  if (!known()) return 0.5f;
  return probability_[bin_of(color).index()];
}

}  // namespace hypotrack::internal
