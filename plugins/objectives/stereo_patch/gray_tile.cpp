#include "gray_tile.hpp"

#include <limits>

#include "hypotrack/plugin/pixel.hpp"

namespace hypotrack::stereo_patch {

PixelPlane<float> gray_tile(const TileView& view, int margin) {
  constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
  const int width = view.color.cols;
  PixelPlane<float> out(width + 2 * margin, view.color.rows);
  for (int y = 0; y < out.height(); ++y) {
    const auto* color = view.color.ptr<cv::Vec3b>(y);
    const auto* valid = view.valid.ptr(y);
    float* row = out.row(y);
    for (int x = 0; x < margin; ++x) row[x] = row[margin + width + x] = kNowhere;
    for (int x = 0; x < width; ++x) {
      const cv::Vec3b& p = color[x];
      row[margin + x] = valid[x] ? gray_level({p[0], p[1], p[2]}) : kNowhere;
    }
  }
  return out;
}

}  // namespace hypotrack::stereo_patch
