#include "cost/cuda/tiles/tile_upload.hpp"

#include <algorithm>

#include "cost/cuda/memory/transfer.hpp"

namespace hypotrack::cuda::internal {
namespace {

std::uint32_t packed(const TileView& view, int y, int x) {
  const bool valid = view.valid.at<unsigned char>(y, x) != 0;
  std::uint32_t word = valid ? kValidFlag : 0;
  if (valid && !view.mask.empty() && view.mask.at<unsigned char>(y, x) != 0) {
    word |= kForegroundFlag;
  }
  if (view.color.empty()) return word;
  const auto& bgr = view.color.at<cv::Vec3b>(y, x);
  return word | bgr[0] | static_cast<std::uint32_t>(bgr[1]) << 8 |
         static_cast<std::uint32_t>(bgr[2]) << 16;
}

}  // namespace

DeviceObservation TileUpload::upload(const Observation& observation, Stream stream) {
  DeviceObservation out;
  *layout_staging_.data() = frame_layout(observation);
  to_device(layout_, layout_staging_, 1, stream);
  out.header = &observation;
  out.frame = layout_.data();
  out.pair = layout_staging_.data()->pair != 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(observation.views.size(), kMaxViews); ++i) {
    const TileView& from = observation.views[i];
    View& to = views_[i];
    const int width = from.camera.width, height = from.camera.height;
    const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    to.pixels.reserve(size);
    to.pixels_staging.reserve(size);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        to.pixels_staging.data()[y * width + x] = packed(from, y, x);
      }
    }
    to_device(to.pixels, to.pixels_staging, size, stream);
    DeviceTile& tile = out.tiles[i];
    tile.layout = {width, height, to.pixels.data(), nullptr};
    tile.has_color = !from.color.empty();
    tile.has_mask = !from.mask.empty();
    if (from.depth.empty()) continue;
    to.depth.reserve(size);
    to.depth_staging.reserve(size);
    for (int y = 0; y < height; ++y) {
      std::copy_n(from.depth.ptr<float>(y), width, to.depth_staging.data() + y * width);
    }
    to_device(to.depth, to.depth_staging, size, stream);
    tile.layout.depth = to.depth.data();
  }
  return out;
}

}  // namespace hypotrack::cuda::internal
