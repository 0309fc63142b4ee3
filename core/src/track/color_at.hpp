#pragma once

#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/core/mat.hpp>

#include "base/exported.hpp"
#include "camera/lens/lens_map.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Interpolates the colour (B, G, R) of an 8-bit image at a point. Returns false outside.
template <class Color>
bool color_at(const cv::Mat& image, const ImagePoint& p, Color& color) {
  const auto is_within = [](float at, int size) {
    return at >= 0 && at < static_cast<float>(size - 1);
  };
  if (!is_within(p.x, image.cols) || !is_within(p.y, image.rows)) return false;
  const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
  const float fx = p.x - static_cast<float>(x), fy = p.y - static_cast<float>(y);
  // A pixel takes four bytes. Those of the right one begin a byte earlier, as the last pixel of a
  // picture has none behind it.
  const auto left = [](const std::uint8_t* at) {
    return cv::v_cvt_f32(cv::v_reinterpret_as_s32(cv::v_load_expand_q(at)));
  };
  const auto right = [&](const std::uint8_t* at) { return cv::v_rotate_right<1>(left(at + 2)); };
  const auto between = [](float share, const cv::v_float32x4& a, const cv::v_float32x4& b) {
    return cv::v_setall_f32(1 - share) * a + cv::v_setall_f32(share) * b;
  };
  const std::uint8_t *const top = image.ptr(y) + 3 * x, *const bottom = image.ptr(y + 1) + 3 * x;
  const cv::v_float32x4 above = between(fx, left(top), right(top));
  const cv::v_float32x4 below = between(fx, left(bottom), right(bottom));
  float out[4];
  cv::v_store(out, between(fy, above, below));
  for (int i = 0; i < 3; ++i) color[i] = out[i];
  return true;
}

}  // namespace internal
}  // namespace hypotrack
