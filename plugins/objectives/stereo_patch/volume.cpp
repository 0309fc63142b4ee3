#include "volume.hpp"

#include <cmath>
#include <limits>

#include "hypotrack/plugin/pixel.hpp"
#include "settings.hpp"
#include "volume_kernel.hpp"

namespace hypotrack::stereo_patch {
namespace {

void weigh(const TileView& view, bool use_mask, float share, Volume& volume) {
  volume.weight = PixelPlane<float>(view.camera.width, view.camera.height);
  volume.uncovered = volume.weight;
  const float root = std::sqrt(share);
  const bool masked = use_mask && !view.mask.empty();
  for (int y = 0; y < volume.weight.height(); ++y) {
    const auto* mask = masked ? view.mask.ptr(y) : nullptr;
    const auto* valid = view.valid.ptr(y);
    for (int x = 0; x < volume.weight.width(); ++x) {
      const bool counts = valid[x] && (!masked || mask[x]);
      volume.weight.row(y)[x] = counts ? share : 0.0f;
      volume.uncovered.row(y)[x] = counts ? root : 0.0f;
    }
  }
}

}  // namespace

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

void make_volume(const Observation& observation, const Settings& settings, Volume& volume) {
  constexpr std::size_t kPadding = 64;  // vectors may reach beyond the last row
  const TileView& left = observation.views[0];
  const TileView& right = observation.views[1];
  volume.planes = planes_around(observation, settings);
  volume.width = left.camera.width;
  volume.height = left.camera.height;
  volume.words.resize(volume.row_stride() * static_cast<std::size_t>(volume.height) + kPadding);
  weigh(left, settings.use_mask, static_cast<float>(share_of(settings, observation)), volume);
  const int margin = left.camera.width;
  fill_volume({stereo_map(observation, 0, 1), gray_tile(left, 0), gray_tile(right, margin), margin},
              settings, volume);
}

}  // namespace hypotrack::stereo_patch
