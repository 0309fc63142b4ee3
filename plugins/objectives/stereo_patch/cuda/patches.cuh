#pragma once

#include "cuda/fill_job.hpp"
#include "hypotrack/gpu/block.cuh"
#include "hypotrack/plugin/pixel.hpp"
#include "hypotrack/plugin/stereo_pixels_map-inl.hpp"

/// Grey values of the two views for a plane in space that is parallel to the first view's tile.
/// Grey is in 0..1, NaN outside. Uses fused multiply-adds where the CPU's vectors have them.
namespace hypotrack::stereo_patch {

__device__ inline float nowhere() { return __int_as_float(0x7FFFFFFF); }

__device__ inline float grey_at(const cuda::TileLayout& tile, int x, int y) {
  if (x < 0 || y < 0 || x >= tile.width || y >= tile.height) return nowhere();
  const std::uint32_t pixel = tile.pixels[y * tile.width + x];
  if (!(pixel & cuda::kValidFlag)) return nowhere();
  return gray_level({static_cast<std::uint8_t>(pixel), static_cast<std::uint8_t>(pixel >> 8),
                     static_cast<std::uint8_t>(pixel >> 16)});
}

__device__ inline float between(float a, float b, float share) {
  return __fmaf_rn(b - a, share, a);
}

/// Returns the second view at pixel (x, y) of the first, warped by the plane of inverse depth w
/// (plane_warp-inl.hpp).
__device__ inline float warped_at(const FillJob& job, float w, int x, int y) {
  if (x < 0 || y < 0 || x >= job.left.width || y >= job.left.height) return nowhere();
  const StereoMap& map = job.map;
  if (map.rectified) {
    const float offset = map.a[0][2] + map.b[0] * w;
    const float whole = floorf(offset);
    const float beyond = static_cast<float>(job.left.width + job.right.width);
    const int shift = static_cast<int>(fminf(fmaxf(whole, -beyond), beyond));
    return between(grey_at(job.right, x + shift, y), grey_at(job.right, x + shift + 1, y),
                   offset - whole);
  }
  const auto m = scalar::map_pixel<false>(map, static_cast<float>(x), static_cast<float>(y), w);
  const auto right = static_cast<float>(map.width - 1), low = static_cast<float>(map.height - 1);
  const bool within = m.u >= 0 && m.u <= right && m.v >= 0 && m.v <= low && m.inverse_depth > 0;
  if (!within) return nowhere();
  const float x0 = fminf(floorf(m.u), right - 1), y0 = fminf(floorf(m.v), low - 1);
  const auto row = [&](int at) {
    const int column = static_cast<int>(x0);
    return between(grey_at(job.right, column, at), grey_at(job.right, column + 1, at), m.u - x0);
  };
  const int upper = static_cast<int>(y0);
  return between(row(upper), row(upper + 1), m.v - y0);
}

}  // namespace hypotrack::stereo_patch
