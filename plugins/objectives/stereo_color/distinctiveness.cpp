#include "distinctiveness.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <iterator>

#include "distinctiveness-inl.hpp"

namespace hypotrack::stereo_color {
namespace {

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
        gx = central_difference(grey[i - 1], grey[i + 1]);
      }
      if (inner && valid[i - width] && valid[i + width]) {
        gy = central_difference(grey[i - width], grey[i + width]);
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

// Returns the bucket of a non-negative float, its exponent and three bits of mantissa. Buckets have
// the order of values.
std::size_t bucket(float value) { return std::bit_cast<std::uint32_t>(value) >> 20; }

// Returns the lower and upper median of non-negative values. It is exact; buckets only reduce the
// values to sort.
MedianPair median_pair(const std::vector<float>& values) {
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
      const Curvature c = curvature(xx, xy, yy);
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      out.major[i] = c.major;
      out.minor[i] = c.minor;
    }
  }
  return out;
}

std::vector<float> distinctiveness(const Curvatures& curvatures,
                                   const std::vector<std::uint8_t>& valid, double w_t) {
  const std::size_t size = valid.size();
  std::vector<float> norm(size), ratio(size), c(size, 0.0f);
  std::vector<float> valid_norm, valid_ratio;
  valid_norm.reserve(size);
  valid_ratio.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    if (!valid[i]) continue;
    const Texture t = texture({curvatures.major[i], curvatures.minor[i]});
    norm[i] = t.norm;
    ratio[i] = t.ratio;
    valid_norm.push_back(norm[i]);
    valid_ratio.push_back(ratio[i]);
  }
  if (valid_norm.empty()) return c;
  const Medians m = medians(median_pair(valid_norm), median_pair(valid_ratio));
  for (std::size_t i = 0; i < size; ++i) {
    if (valid[i]) c[i] = distinctiveness({norm[i], ratio[i]}, m, static_cast<float>(w_t));
  }
  return c;
}

}  // namespace hypotrack::stereo_color
