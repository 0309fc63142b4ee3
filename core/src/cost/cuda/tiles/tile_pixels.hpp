#pragma once

#include <cstdint>

#include "base/exported.hpp"
#include "camera/lens/lens_map.hpp"
#include "hypotrack/gpu/layout.hpp"
#include "hypotrack/plugin/pixel.hpp"
#include "tile/color_map.hpp"

/// Computes a tile's pixels one by one, in kernels and in host tests. The functions repeat the
/// OpenCV calls of Resampler::resample (INTER_AREA means, remap with INTER_LINEAR) with their
/// rounding: lookups to 1/32 pixel, results to integers after each step.
namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// A rectangle of an image.
struct ImagePart {
  std::int32_t x, y, width, height;
};

/// The parameters, input and output of a tile's resampling. Images are parts of the view's, row by
/// row without gaps.
struct ViewResampling {
  LensMap lens;
  TileIntrinsics camera;
  std::int32_t width, height;  ///< of the tile
  std::int32_t image_width, image_height;
  std::int32_t blocks;   ///< ReductionPlan
  std::int32_t samples;  ///< ReductionPlan: 1 or 2
  float means_scale;     ///< from image coordinates to those of the means
  float means_x, means_y;
  ColorMap colors;
  ImagePart touched;           ///< the part in `color` and `mask`, whole blocks
  ImagePart measured;          ///< the part in `depth`
  const unsigned char* color;  ///< BGR; null if the view has none
  const unsigned char* mask;   ///< null if the view has none
  const float* depth;          ///< null if the view has none
  std::uint32_t* means;        ///< over the blocks of `touched`; null without colour and mask
  std::uint32_t* tile_pixels;  ///< TileLayout
  float* tile_depth;           ///< TileLayout; null without depth
};

/// Sums of the four 8-bit channels of words: blue, green, red and mask, lowest first.
struct Channels {
  std::uint32_t sum[4] = {};

  HYPOTRACK_PIXEL void add(std::uint32_t word, std::uint32_t weight) {
    for (int i = 0; i < 4; ++i) sum[i] += ((word >> (8 * i)) & 255) * weight;
  }
  HYPOTRACK_PIXEL std::uint32_t rounded(std::uint32_t half, int shift) const {
    std::uint32_t word = 0;
    for (int i = 0; i < 4; ++i) word |= ((sum[i] + half) >> shift) << (8 * i);
    return word;
  }
};

/// Returns the rounded mean of `blocks` x `blocks` numbers, given their sum.
HYPOTRACK_PIXEL std::uint32_t rounded_mean(std::uint32_t sum, int blocks) {
  if (blocks == 1) return sum;
  if (blocks == 2) return (sum + 2) >> 2;
  const float scale = 1.0f / static_cast<float>(blocks * blocks);
  return static_cast<std::uint32_t>(pixel::round(static_cast<float>(sum) * scale));
}

/// Returns the channel means over a block of the touched part.
HYPOTRACK_PIXEL std::uint32_t block_mean(const ViewResampling& view, int column, int row) {
  const int blocks = view.blocks;
  std::uint32_t b = 0, g = 0, r = 0, mask = 0;
  for (int y = row * blocks; y < (row + 1) * blocks; ++y) {
    for (int x = column * blocks; x < (column + 1) * blocks; ++x) {
      const int at = y * view.touched.width + x;
      if (view.color) {
        b += view.color[3 * at];
        g += view.color[3 * at + 1];
        r += view.color[3 * at + 2];
      }
      if (view.mask) mask += view.mask[at] ? 255u : 0u;
    }
  }
  return rounded_mean(b, blocks) | rounded_mean(g, blocks) << 8 | rounded_mean(r, blocks) << 16 |
         rounded_mean(mask, blocks) << 24;
}

/// Converts a coordinate to units of 1/32 pixel.
HYPOTRACK_PIXEL int in_fixed_point(float coordinate) {
  constexpr float kFar = 1e5f;  // beyond any image; larger integers are still exact
  return static_cast<int>(pixel::round(pixel::min(pixel::max(coordinate, -kFar), kFar) * 32.0f));
}

HYPOTRACK_PIXEL int clamped(int i, int size) { return i < 0 ? 0 : i < size ? i : size - 1; }

/// Samples the means bilinearly; their border is repeated outside.
HYPOTRACK_PIXEL std::uint32_t look_up(const ViewResampling& view, ImagePoint p) {
  const int columns = view.touched.width / view.blocks;
  const int rows = view.touched.height / view.blocks;
  const int x = in_fixed_point(p.x);
  const int y = in_fixed_point(p.y);
  const int x0 = clamped(x >> 5, columns), x1 = clamped((x >> 5) + 1, columns);
  const int y0 = clamped(y >> 5, rows), y1 = clamped((y >> 5) + 1, rows);
  const std::uint32_t a = x & 31, b = y & 31;
  const std::uint32_t* top = view.means + y0 * columns;
  const std::uint32_t* bottom = view.means + y1 * columns;
  Channels c;
  c.add(top[x0], (32 - a) * (32 - b));
  c.add(top[x1], a * (32 - b));
  c.add(bottom[x0], (32 - a) * b);
  c.add(bottom[x1], a * b);
  return c.rounded(512, 10);
}

/// Converts image coordinates to those of the means.
HYPOTRACK_PIXEL ImagePoint in_means(const ViewResampling& view, ImagePoint p) {
  return {std::fma(p.x, view.means_scale, view.means_x),
          std::fma(p.y, view.means_scale, view.means_y)};
}

/// Returns the point a quarter of the way from `b` to `a`.
HYPOTRACK_PIXEL ImagePoint quarter(ImagePoint a, ImagePoint b) {
  return {a.x * 0.25f + b.x * 0.75f, a.y * 0.25f + b.y * 0.75f};
}

/// Samples the colour and mask of a tile's pixel. `map(column, row)` returns the image_point() of
/// the pixel and its neighbours.
template <class Map>
HYPOTRACK_PIXEL std::uint32_t sampled(const ViewResampling& view, const Map& map, int u, int v) {
  const ImagePoint centre = in_means(view, map(u, v));
  if (view.samples == 1) return look_up(view, centre);
  Channels c;
  for (int j = -1; j <= 1; j += 2) {
    const ImagePoint beyond = in_means(view, map(u, v + j));
    for (int i = -1; i <= 1; i += 2) {
      const ImagePoint row = quarter(in_means(view, map(u + i, v)), centre);
      const ImagePoint next = quarter(in_means(view, map(u + i, v + j)), beyond);
      c.add(look_up(view, quarter(next, row)), 1);
    }
  }
  return c.rounded(2, 2);
}

/// Maps the blue, green and red of a word; the highest byte becomes 0.
HYPOTRACK_PIXEL std::uint32_t mapped_colors(const ColorMap& map, std::uint32_t word) {
  std::uint32_t out = 0;
  for (int i = 0; i < 3; ++i) out |= mapped_channel(map, i, (word >> (8 * i)) & 255) << (8 * i);
  return out;
}

/// Returns a tile's pixel in the format of TileLayout.
template <class Map>
HYPOTRACK_PIXEL std::uint32_t tile_pixel(const ViewResampling& view, const Map& map, int u, int v) {
  const bool valid = inside_image(map(u, v), view.image_width, view.image_height);
  std::uint32_t word = valid ? kValidFlag : 0;
  if (!view.means) return word;
  const std::uint32_t color_and_mask = sampled(view, map, u, v);
  if (valid && (color_and_mask >> 31) != 0) word |= kForegroundFlag;
  return view.color ? word | mapped_colors(view.colors, color_and_mask) : word;
}

/// Returns the depth of a tile's pixel at image point `p`, from the nearest pixel; 0 if there is
/// none.
HYPOTRACK_PIXEL float tile_depth(const ViewResampling& view, ImagePoint p, int u, int v) {
  if (!inside_image(p, view.image_width, view.image_height)) return 0.0f;
  const ImagePart& part = view.measured;
  const int column = clamped(nearest_pixel(p.x, view.image_width) - part.x, part.width);
  const int row = clamped(nearest_pixel(p.y, view.image_height) - part.y, part.height);
  const float depth = view.depth[row * part.width + column];
  const float along = depth_along_tile(view.lens, view.camera, u, v, depth);
  constexpr float kLargest = 3.4e38f;
  return along > 0.0f && along < kLargest ? along : 0.0f;
}

}  // namespace internal
}  // namespace hypotrack::cuda
