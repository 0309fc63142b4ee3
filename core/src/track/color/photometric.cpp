#include "track/color/photometric.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "track/color/color_fit.hpp"
#include "track/color/color_samples.hpp"

namespace hypotrack::internal {
namespace {

// A line is determined by its values at two levels; their changes are limited.
constexpr float kLow = 64, kHigh = 192;
// Measured with an articulated model of 0.2 m: the views' samples of its surface correlate by 0.7
// or more if the pose is within 6 mm, and by less than 0.45 if it is 30 mm off.
constexpr double kSameSurface = 0.5;
// After this many frames the pose comes from a search, and the map may only change slowly.
constexpr int kSettled = 3;

float moved(float from, float to, float rate, float largest) {
  return from + std::clamp(rate * (to - from), -largest, largest);
}

/// Samples the colours of whole pictures, sorted: matching quantiles are paired.
ColorSamples of_pictures(const Frame& frame, std::size_t other) {
  constexpr int kStep = 8;  // pixels
  const auto sorted = [](const cv::Mat& picture, std::size_t channel) {
    std::vector<float> out;
    for (int y = kStep / 2; y < picture.rows; y += kStep)
      for (int x = kStep / 2; x < picture.cols; x += kStep)
        out.push_back(picture.at<cv::Vec3b>(y, x)[static_cast<int>(channel)]);
    std::ranges::sort(out);
    return out;
  };
  ColorSamples samples;
  if (frame.views[0].color.size() != frame.views[other].color.size()) return samples;
  for (std::size_t i = 0; i < 3; ++i) {
    samples.first[i] = sorted(frame.views[0].color, i);
    samples.other[i] = sorted(frame.views[other].color, i);
  }
  return samples;
}

/// Returns the samples with all channels of the first view darkened by `by`.
ColorSamples darkened(ColorSamples samples, const Eigen::VectorXf& by) {
  for (std::vector<float>& channel : samples.first)
    Eigen::Map<Eigen::VectorXf>(channel.data(), by.size()) -= by;
  return samples;
}

}  // namespace

PhotometricMatch::PhotometricMatch(const Scene& scene, const PhotometricSettings& settings)
    : settings_(settings), sampler_(scene) {}

void PhotometricMatch::learn(const TileMaker& tiles, const Frame& frame, const TilePlan& plan,
                             const Eigen::VectorXd& state) {
  if (!settings_.match || plan.views.size() < 2) return;
  views().resize(plan.views.size() - 1);
  sampler_.draw(plan.header, state);
  std::vector<ColorSamples> samples;
  for (std::size_t i = 0; i < views_.size(); ++i)
    samples.push_back(sampler_.take(frame, tiles.resamplers(), i + 1, settings_.highlights));
  learning_.begin([this, samples = std::move(samples)] {
    for (std::size_t i = 0; i < views_.size(); ++i) learn(views_[i], samples[i], i + 1);
  });
}

std::vector<PhotometricMatch::Learned>& PhotometricMatch::views() {
  learning_.wait();
  return views_;
}

const std::vector<PhotometricMatch::Learned>& PhotometricMatch::views() const {
  learning_.wait();
  return views_;
}

void PhotometricMatch::begin(const TileMaker& tiles, const Frame& frame, const TilePlan& plan,
                             const Eigen::VectorXd& start) {
  if (!settings_.match || plan.views.size() < 2) return;
  views().resize(plan.views.size() - 1);
  sampler_.draw(plan.header, start);
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const ColorSamples samples =
        sampler_.take(frame, tiles.resamplers(), i + 1, settings_.highlights);
    if (correlation(samples) >= kSameSurface) {
      learn(views_[i], samples, i + 1);
    } else if (const auto map = fit_color_map(of_pictures(frame, i + 1))) {
      views_[i].map = *map;
    }
  }
}

void PhotometricMatch::learn(Learned& learned, const ColorSamples& samples,
                             std::size_t view) const {
  if (settings_.highlights) {
    learn_both(learned, samples, sampler_.directions(view));
  } else if (const auto found = fit_color_map(samples)) {
    update(learned, *found, median_difference(samples, *found));
  }
}

void PhotometricMatch::learn_both(Learned& learned, const ColorSamples& samples,
                                  const ViewDirections& to) const {
  Highlights& highlights = learned.highlights;
  const auto found = fit_color_map(darkened(samples, highlights.expected(samples.normals, to)));
  if (!found) return;
  highlights.learn(samples.normals, gray_difference(samples, *found), to);
  const ColorSamples diffuse = darkened(samples, highlights.expected(samples.normals, to));
  update(learned, *found, median_difference(diffuse, *found));
}

void PhotometricMatch::update(Learned& learned, const ColorMap& found, double difference) const {
  ++learned.frames;
  const float rate =
      std::max(static_cast<float>(settings_.rate), 1.0f / static_cast<float>(learned.frames));
  learned.difference += double{rate} * (difference - learned.difference);
  const float largest = learned.frames <= kSettled ? 255 : static_cast<float>(settings_.max_change);
  for (int i = 0; i < 3; ++i) {
    float& gain = learned.map.gain[i];
    float& offset = learned.map.offset[i];
    const auto value_at = [&](float level) {
      return moved(gain * level + offset, found.gain[i] * level + found.offset[i], rate, largest);
    };
    const float low = value_at(kLow), high = value_at(kHigh);
    gain = (high - low) / (kHigh - kLow);
    offset = low - gain * kLow;
  }
}

void PhotometricMatch::follow(std::span<const float> gains) {
  for (std::size_t i = 0; i < views().size() && i + 1 < gains.size(); ++i)
    for (std::size_t channel = 0; channel < 3; ++channel) {
      views_[i].map.gain[channel] *= gains[0] / gains[i + 1];
      views_[i].map.offset[channel] *= gains[0];
    }
}

bool PhotometricMatch::knows() const {
  return std::ranges::any_of(views(), [](const Learned& l) { return l.frames > 0; });
}

void PhotometricMatch::apply_highlights(TilePlan& plan, const Eigen::VectorXd& state) {
  if (!settings_.highlights || !knows()) return;
  sampler_.draw(plan.header, state);
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const ColorSampler::NormalGrid grid = sampler_.normals(i + 1);
    const Eigen::VectorXf missing =
        views_[i].highlights.expected(grid.normals, sampler_.directions(i + 1));
    const TileCamera& camera = plan.header.views[i + 1].camera;
    plan.views[i + 1].brightness = extrapolate(grid.inside, missing, {camera.width, camera.height});
  }
}

void PhotometricMatch::apply(TilePlan& plan) const {
  for (std::size_t i = 0; i < views().size(); ++i) plan.views[i + 1].colors = views_[i].map;
  if (!views().empty()) plan.header.context.color_difference = views_[0].difference;
}

}  // namespace hypotrack::internal
