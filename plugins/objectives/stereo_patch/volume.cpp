#include "volume.hpp"

#include "gray_tile.hpp"
#include "volume_kernel.hpp"

namespace hypotrack::stereo_patch {
namespace {

PixelPlane<float> weights(const TileView& view, bool use_mask) {
  PixelPlane<float> out(view.camera.width, view.camera.height);
  const bool masked = use_mask && !view.mask.empty();
  for (int y = 0; y < out.height(); ++y) {
    const auto* mask = masked ? view.mask.ptr(y) : nullptr;
    const auto* valid = view.valid.ptr(y);
    for (int x = 0; x < out.width(); ++x) {
      out.row(y)[x] = valid[x] && (!masked || mask[x]) ? 1.0f : 0.0f;
    }
  }
  return out;
}

}  // namespace

void make_volume(const Observation& observation, const Settings& settings, Volume& volume) {
  constexpr std::size_t kPadding = 64;  // vectors may reach beyond the last row
  const TileView& left = observation.views[0];
  const TileView& right = observation.views[1];
  volume.planes = planes_around(observation, settings);
  volume.width = left.camera.width;
  volume.height = left.camera.height;
  volume.words.resize(volume.row_stride() * static_cast<std::size_t>(volume.height) + kPadding);
  volume.weight = weights(left, settings.use_mask);
  const int margin = left.camera.width;
  fill_volume({stereo_map(observation, 0, 1), gray_tile(left, 0), gray_tile(right, margin), margin},
              settings, volume);
}

}  // namespace hypotrack::stereo_patch
