#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "hypotrack/plugin/pixel.hpp"

/// Colour spaces of one pixel, for the CPU and for CUDA: channels in 0..1 as features.hpp defines
/// them.
namespace hypotrack::stereo_color {

/// Returns the colour of a pixel of a cuda::TileLayout.
HYPOTRACK_PIXEL Bgr to_bgr(std::uint32_t pixel) {
  return {static_cast<std::uint8_t>(pixel), static_cast<std::uint8_t>(pixel >> 8),
          static_cast<std::uint8_t>(pixel >> 16)};
}

struct Channels {
  float c0, c1, c2;
};

HYPOTRACK_PIXEL Channels rgb_channels(Bgr p) {
  return {static_cast<float>(p.r) / 255.0f, static_cast<float>(p.g) / 255.0f,
          static_cast<float>(p.b) / 255.0f};
}

/// Scales the mean of the channels, about one half, by `share`: highlights change all channels
/// alike. A share of 1 leaves colours unchanged, bit by bit.
HYPOTRACK_PIXEL Channels with_gray_share(const Channels& c, float share) {
  const float taken = (1.0f - share) * ((c.c0 + c.c1 + c.c2) * (1.0f / 3.0f) - 0.5f);
  return {c.c0 - taken, c.c1 - taken, c.c2 - taken};
}

/// Hue in degrees, saturation and value 0..1.
struct Hsv {
  float h, s, v;
};

/// Converts as OpenCV's COLOR_BGR2HSV does for 32-bit float.
HYPOTRACK_PIXEL Hsv to_hsv(const Channels& rgb) {
  constexpr float kEpsilon = 1.1920929e-7f;
  const float v = pixel::max(pixel::max(rgb.c0, rgb.c1), rgb.c2);
  const float span = v - pixel::min(pixel::min(rgb.c0, rgb.c1), rgb.c2);
  const float scale = 60.0f / (span + kEpsilon);
  float h = 0.0f;
  if (v == rgb.c0) {
    h = (rgb.c1 - rgb.c2) * scale;
  } else if (v == rgb.c1) {
    h = (rgb.c2 - rgb.c0) * scale + 120.0f;
  } else {
    h = (rgb.c0 - rgb.c1) * scale + 240.0f;
  }
  return {h < 0.0f ? h + 360.0f : h, span / (v + kEpsilon), v};
}

HYPOTRACK_PIXEL Channels on_cone(const Hsv& p) {
  const float angle = p.h * std::numbers::pi_v<float> / 180.0f;
  const float radius = 0.5f * p.s * p.v;
  return {0.5f + radius * std::cos(angle), 0.5f + radius * std::sin(angle), p.v};
}

/// Scales L (0..100), a and b (about -128..127) to channels in 0..1.
HYPOTRACK_PIXEL Channels lab_channels(float l, float a, float b) {
  return {l / 100.0f, (a + 128.0f) / 255.0f, (b + 128.0f) / 255.0f};
}

/// Table of Lab colours for to_lab(). OpenCV's COLOR_BGR2Lab for 32-bit float interpolates between
/// kLabNodes^3 colours, in 16ths of their distance, up to 2e-3 of the range off the CIE's
/// equations. to_lab() does the same with the same numbers. LabNode is the Lab of (r, g, b) /
/// (kLabNodes - 1), at (r * kLabNodes + g) * kLabNodes + b, in units of 100 / 2^14 and 256 / 2^14
/// (from -128 on).
inline constexpr int kLabNodes = 33;
inline constexpr int kLabNodeCount = kLabNodes * kLabNodes * kLabNodes;
inline constexpr float kLabUnit = 1.0f / 16384.0f;
struct alignas(8) LabNode {
  std::int16_t l, a, b, unused;
};

/// Returns the table for to_lab(), computed by OpenCV.
std::vector<LabNode> lab_nodes();

/// Position of an 8-bit value between two nodes.
struct LabStep {
  int node, sixteenths;
};
HYPOTRACK_PIXEL LabStep lab_step(std::uint8_t value) {
  const float scaled = static_cast<float>(value) * (1.0f / 255.0f) * 16384.0f;
  const int fine = static_cast<int>(pixel::round(scaled));
  return {fine >> 9, (fine >> 5) & 15};
}

HYPOTRACK_PIXEL Channels to_lab(Bgr p, const LabNode* nodes) {
  const LabStep r = lab_step(p.r), g = lab_step(p.g), b = lab_step(p.b);
  int sum_l = 2048, sum_a = 2048, sum_b = 2048;  // half of 16^3, to round
  for (int corner = 0; corner < 8; ++corner) {
    const int dr = corner >> 2, dg = corner >> 1 & 1, db = corner & 1;
    const int weight = (dr ? r.sixteenths : 16 - r.sixteenths) *
                       (dg ? g.sixteenths : 16 - g.sixteenths) *
                       (db ? b.sixteenths : 16 - b.sixteenths);
    if (weight == 0) continue;  // also keeps the last index within the table
    const LabNode node = nodes[((r.node + dr) * kLabNodes + g.node + dg) * kLabNodes + b.node + db];
    sum_l += weight * node.l;
    sum_a += weight * node.a;
    sum_b += weight * node.b;
  }
  const auto value = [](int sum) { return static_cast<float>(sum >> 12) * kLabUnit; };
  return lab_channels(value(sum_l) * 100.0f, value(sum_a) * 256.0f - 128.0f,
                      value(sum_b) * 256.0f - 128.0f);
}

}  // namespace hypotrack::stereo_color
