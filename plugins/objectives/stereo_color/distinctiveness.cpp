#include "distinctiveness.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace hypotrack::stereo_color {
namespace {

// Keeps the logarithm finite where the image is flat.
constexpr float kLogGuard = 1e-12f;

// The products gx gx, gx gy, gy gy of one row of gradients, with a zero column on either side.
struct Products {
  std::vector<float> xx, xy, yy;
  explicit Products(int width) : xx(width + 2), xy(width + 2), yy(width + 2) {}

  void fill(const std::vector<float>& grey, const std::vector<std::uint8_t>& valid, int width,
            int height, int y) {
    const auto row = static_cast<std::size_t>(y) * width;
    const bool inner = y > 0 && y + 1 < height;
    for (int x = 0; x < width; ++x) {
      const std::size_t i = row + x;
      float gx = 0, gy = 0;
      if (x > 0 && x + 1 < width && valid[i - 1] && valid[i + 1]) {
        gx = 0.5f * (grey[i + 1] - grey[i - 1]);
      }
      if (inner && valid[i - width] && valid[i + width]) {
        gy = 0.5f * (grey[i + width] - grey[i - width]);
      }
      xx[x + 1] = gx * gx;
      xy[x + 1] = gx * gy;
      yy[x + 1] = gy * gy;
    }
  }
  void clear() {
    for (auto* plane : {&xx, &xy, &yy}) std::fill(plane->begin(), plane->end(), 0.0f);
  }
};

float sum_3x3(const float* a, const float* b, const float* c) {
  return (a[0] + a[1] + a[2]) + (b[0] + b[1] + b[2]) + (c[0] + c[1] + c[2]);
}

// The bucket of a non-negative float: exponent and three bits of mantissa, in the order of values.
std::size_t bucket(float value) { return std::bit_cast<std::uint32_t>(value) >> 20; }

// The middle one or two of non-negative values; the two are equal for an odd count. Exact; buckets
// only leave few values to look at.
std::array<float, 2> middle(const std::vector<float>& values) {
  std::array<std::size_t, 2048> counts{};
  for (const float v : values) ++counts[bucket(v)];
  const auto ranked = [&](std::size_t rank) {
    std::size_t b = 0;
    for (; rank >= counts[b]; ++b) rank -= counts[b];
    std::vector<float> candidates;
    candidates.reserve(counts[b]);
    std::copy_if(values.begin(), values.end(), std::back_inserter(candidates),
                 [b](float v) { return bucket(v) == b; });
    const auto at = candidates.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(candidates.begin(), at, candidates.end());
    return *at;
  };
  const float upper = ranked(values.size() / 2);
  return {values.size() % 2 == 1 ? upper : ranked(values.size() / 2 - 1), upper};
}

}  // namespace

Curvatures principal_curvatures(const std::vector<float>& grey,
                                const std::vector<std::uint8_t>& valid, int width, int height) {
  Curvatures out;
  out.major.resize(grey.size());
  out.minor.resize(grey.size());
  std::array<Products, 3> rows{Products(width), Products(width), Products(width)};
  rows[1].fill(grey, valid, width, height, 0);
  for (int y = 0; y < height; ++y) {
    const Products& above = rows[y % 3];
    const Products& here = rows[(y + 1) % 3];
    Products& below = rows[(y + 2) % 3];
    if (y + 1 < height) {
      below.fill(grey, valid, width, height, y + 1);
    } else {
      below.clear();
    }
    for (int x = 0; x < width; ++x) {
      const float xx = sum_3x3(&above.xx[x], &here.xx[x], &below.xx[x]);
      const float xy = sum_3x3(&above.xy[x], &here.xy[x], &below.xy[x]);
      const float yy = sum_3x3(&above.yy[x], &here.yy[x], &below.yy[x]);
      const float mean = 0.5f * (xx + yy);
      const float half = 0.5f * (xx - yy);
      const float radius = std::sqrt(half * half + xy * xy);
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      out.major[i] = mean + radius;
      out.minor[i] = std::max(mean - radius, 0.0f);  // rounding can make it negative
    }
  }
  return out;
}

// exp(d) and the ratio minor/major order the pixels as d and a do, so the medians are found on them
// and the sigmoid of d needs neither logarithm nor exponential:
//   1 / (1 + exp(m - d)) = exp(d) / (exp(d) + exp(m)).
std::vector<float> distinctiveness(const Curvatures& curvatures,
                                   const std::vector<std::uint8_t>& valid, double w_t) {
  const std::size_t size = valid.size();
  std::vector<float> norm(size), ratio(size), c(size, 0.0f);
  std::vector<float> valid_norm, valid_ratio;
  valid_norm.reserve(size);
  valid_ratio.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    if (!valid[i]) continue;
    const float major = curvatures.major[i], minor = curvatures.minor[i];
    norm[i] = std::sqrt(major * major + minor * minor) + kLogGuard;
    ratio[i] = major > 0 ? minor / major : 0.0f;
    valid_norm.push_back(norm[i]);
    valid_ratio.push_back(ratio[i]);
  }
  if (valid_norm.empty()) return c;
  const auto [norm_low, norm_high] = middle(valid_norm);
  const auto [ratio_low, ratio_high] = middle(valid_ratio);
  const float exp_median_d = std::sqrt(norm_low) * std::sqrt(norm_high);
  const float median_a = 0.5f * (std::atan(ratio_low) + std::atan(ratio_high));
  for (std::size_t i = 0; i < size; ++i) {
    if (!valid[i]) continue;
    const float d_s = norm[i] / (norm[i] + exp_median_d);
    const float a_s = 1.0f / (1.0f + std::exp(median_a - std::atan(ratio[i])));
    const float product = d_s * a_s;
    c[i] = product < static_cast<float>(w_t) ? 0.0f : product;
  }
  return c;
}

}  // namespace hypotrack::stereo_color
